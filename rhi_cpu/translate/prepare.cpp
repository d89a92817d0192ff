#include "rhi_cpu/translate/prepare.hpp"

#include <unordered_map>
#include <unordered_set>

#include <fmt/format.h>
#include <spirv-tools/optimizer.hpp>
#include <spirv_cross/spirv.hpp>

#include "rhi/error.hpp"
#include "rhi/spirv_validation.hpp"
#include "rhi_cpu/translate/refusal.hpp"
#include "rhi_cpu/translate/spirv_names.hpp"
#include "rhi_cpu/translate/supported.hpp"

namespace tandem::cpu {
namespace {

constexpr std::size_t header_words = 5;

/// Calls visit(instruction) for each instruction of the module.
template <typename Word, typename Visit>
void for_each_instruction(std::span<Word> spirv, const Visit& visit) {
  for (std::size_t i = header_words; i < spirv.size(); i += spirv[i] >> 16) visit(spirv.subspan(i, spirv[i] >> 16));
}

spv::Op operation(std::span<const std::uint32_t> instruction) { return static_cast<spv::Op>(instruction[0] & 0xffff); }

[[noreturn]] void fail(const std::string& label, const std::string& why) {
  throw rhi::Error(rhi::ErrorCode::invalid_argument, label, why);
}

bool has_specialization(std::span<const std::uint32_t> spirv) {
  bool found = false;
  for_each_instruction(spirv, [&](std::span<const std::uint32_t> i) {
    const spv::Op op = operation(i);
    found |= op >= spv::OpSpecConstantTrue && op <= spv::OpSpecConstantOp;
  });
  return found;
}

template <typename RegisterPasses>
std::vector<std::uint32_t> optimize(std::span<const std::uint32_t> spirv, const std::string& label,
                                    const RegisterPasses& register_passes) {
  spvtools::Optimizer optimizer(SPV_ENV_UNIVERSAL_1_6);
  std::string first_message;
  optimizer.SetMessageConsumer([&](spv_message_level_t, const char*, const spv_position_t&, const char* message) {
    if (first_message.empty()) first_message = message;
  });
  register_passes(optimizer);
  spvtools::OptimizerOptions options;
  options.set_run_validator(false);
  std::vector<std::uint32_t> result;
  if (!optimizer.Run(spirv.data(), spirv.size(), &result, options))
    fail(label, "the specialisation constants cannot be applied: " + first_message);
  return result;
}

/// Replaces each OpSpecConstantOp that only picks a constant (Select by a scalar condition, CompositeExtract of a
/// constant composite), which SPIRV-Tools folds for integers alone, by a copy of the constant that it picks. Returns
/// whether there was one.
bool pick_constants(std::vector<std::uint32_t>& spirv) {
  std::vector<std::uint32_t> result(spirv.begin(), spirv.begin() + header_words);
  std::unordered_map<std::uint32_t, std::vector<std::uint32_t>> constants;  // declarations by result id
  bool changed = false;
  for_each_instruction(std::span<const std::uint32_t>(spirv), [&](std::span<const std::uint32_t> i) {
    std::vector<std::uint32_t> instruction(i.begin(), i.end());
    if (operation(i) == spv::OpSpecConstantOp) {
      std::uint32_t picked = 0;
      const auto declaration = constants.find(i[4]);
      if (declaration != constants.end()) {
        const std::vector<std::uint32_t>& operand = declaration->second;
        if (i[3] == spv::OpSelect && operation(operand) == spv::OpConstantTrue) picked = i[5];
        if (i[3] == spv::OpSelect && operation(operand) == spv::OpConstantFalse) picked = i[6];
        if (i[3] == spv::OpCompositeExtract && operation(operand) == spv::OpConstantComposite && i.size() == 6)
          picked = operand[3 + i[5]];
      }
      if (const auto constant = constants.find(picked); constant != constants.end()) {
        instruction = constant->second;
        instruction[2] = i[2];
        changed = true;
      }
    }
    if (const spv::Op op = operation(instruction); op >= spv::OpConstantTrue && op <= spv::OpConstantNull)
      constants[instruction[2]] = instruction;
    result.insert(result.end(), instruction.begin(), instruction.end());
  });
  if (changed) spirv = std::move(result);
  return changed;
}

std::vector<std::uint32_t> specialize(std::span<const std::uint32_t> spirv, const std::string& label,
                                      std::span<const rhi::SpecializationValue> values) {
  std::unordered_set<std::uint32_t> declared;
  for_each_instruction(spirv, [&](std::span<const std::uint32_t> i) {
    if (operation(i) == spv::OpDecorate && i[2] == spv::DecorationSpecId) declared.insert(i[3]);
  });
  std::unordered_map<std::uint32_t, std::vector<std::uint32_t>> words;
  for (const rhi::SpecializationValue& value : values) {
    if (!declared.contains(value.id))
      fail(label, fmt::format("the shader has no specialisation constant {}", value.id));
    words[value.id] = {value.value};
  }
  if (!has_specialization(spirv)) return {spirv.begin(), spirv.end()};

  std::vector<std::uint32_t> result = optimize(spirv, label, [&](spvtools::Optimizer& optimizer) {
    optimizer.RegisterPass(spvtools::CreateSetSpecConstantDefaultValuePass(words));
    optimizer.RegisterPass(spvtools::CreateFreezeSpecConstantValuePass());
    optimizer.RegisterPass(spvtools::CreateFoldSpecConstantOpAndCompositePass());
  });
  // What one side folds may let the other fold more.
  while (pick_constants(result))
    result = optimize(result, label, [](spvtools::Optimizer& optimizer) {
      optimizer.RegisterPass(spvtools::CreateFoldSpecConstantOpAndCompositePass());
    });
  return result;
}

/// Folding leaves what it cannot compute.
void check_folded(std::span<const std::uint32_t> spirv, const std::string& label) {
  for_each_instruction(spirv, [&](std::span<const std::uint32_t> i) {
    if (operation(i) == spv::OpSpecConstantOp) refuse(label, "OpSpecConstantOp with " + folded_operation_name(i));
  });
}

}  // namespace

std::vector<std::uint32_t> prepare(std::span<const std::uint32_t> spirv, const std::string& label,
                                   std::span<const rhi::SpecializationValue> specialization) {
  rhi::check_spirv_words(spirv, label);
  check_supported(spirv, label);
  rhi::check_spirv(spirv, label);
  std::vector<std::uint32_t> words = specialize(spirv, label, specialization);
  check_folded(words, label);
  for_each_instruction(std::span(words), [](std::span<std::uint32_t> i) {
    if (operation(i) == spv::OpUndef) i[0] = 3u << 16 | spv::OpConstantNull;
  });
  return words;
}

}  // namespace tandem::cpu
