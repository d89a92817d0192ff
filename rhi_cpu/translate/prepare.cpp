#include "rhi_cpu/translate/prepare.hpp"

#include <algorithm>
#include <cstdint>
#include <unordered_map>
#include <unordered_set>

#include <fmt/format.h>
#include <spirv-tools/optimizer.hpp>
#include <spirv_cross/spirv.hpp>

#include "rhi/error.hpp"
#include "rhi/spirv/names.hpp"
#include "rhi/spirv/words.hpp"
#include "rhi/spirv_validation.hpp"
#include "rhi_cpu/translate/folding/constant_folding.hpp"
#include "rhi_cpu/translate/refusal.hpp"
#include "rhi_cpu/translate/supported.hpp"
#include "rhi_cpu/translate/wide/plain_copies.hpp"
#include "rhi_cpu/translate/wide/value_parameters.hpp"

namespace tandem::cpu {
namespace {

using rhi::for_each_instruction;
using rhi::operation_of;

[[noreturn]] void fail(const std::string& label, const std::string& why) {
  throw rhi::Error(rhi::ErrorCode::invalid_argument, label, why);
}

bool has_specialization(std::span<const std::uint32_t> spirv) {
  bool found = false;
  for_each_instruction(spirv, [&](std::span<const std::uint32_t> i) {
    const spv::Op op = operation_of(i);
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

std::vector<std::uint32_t> specialize(std::span<const std::uint32_t> spirv, const std::string& label,
                                      std::span<const rhi::SpecializationValue> values) {
  constexpr std::size_t words_before_literal = 3;
  std::unordered_map<std::uint32_t, std::uint32_t> spec_ids;  // of a constant's id
  std::unordered_map<std::uint32_t, bool> is_wide;            // whether the constant of a SpecId has 64 bits
  for_each_instruction(spirv, [&](std::span<const std::uint32_t> i) {
    if (operation_of(i) == spv::OpDecorate && i[2] == spv::DecorationSpecId) {
      spec_ids[i[1]] = i[3];
      is_wide[i[3]] = false;
    }
    if (operation_of(i) == spv::OpSpecConstant && spec_ids.contains(i[2]))
      is_wide[spec_ids[i[2]]] = i.size() > words_before_literal + 1;
  });
  std::unordered_map<std::uint32_t, std::vector<std::uint32_t>> words;
  for (const rhi::SpecializationValue& value : values) {
    const auto known = is_wide.find(value.id);
    if (known == is_wide.end()) fail(label, fmt::format("the shader has no specialisation constant {}", value.id));
    words[value.id] = {static_cast<std::uint32_t>(value.value)};
    if (known->second) words[value.id].push_back(static_cast<std::uint32_t>(value.value >> 32));
  }
  if (!has_specialization(spirv)) return {spirv.begin(), spirv.end()};

  return fold_constants(optimize(spirv, label, [&](spvtools::Optimizer& optimizer) {
    optimizer.RegisterPass(spvtools::CreateSetSpecConstantDefaultValuePass(words));
    optimizer.RegisterPass(spvtools::CreateFreezeSpecConstantValuePass());
  }));
}

/// Folding leaves what it cannot compute.
void check_folded(std::span<const std::uint32_t> spirv, const std::string& label) {
  for_each_instruction(spirv, [&](std::span<const std::uint32_t> i) {
    if (operation_of(i) == spv::OpSpecConstantOp)
      refuse(label, "OpSpecConstantOp with " + rhi::folded_operation_name(i));
  });
}

/// A constant may have become the length of an array; the validator has only seen its default.
void check_lengths(std::span<const std::uint32_t> spirv, const std::string& label) {
  std::unordered_map<std::uint32_t, std::uint32_t> constants;
  for_each_instruction(spirv, [&](std::span<const std::uint32_t> i) {
    if (operation_of(i) == spv::OpConstant) constants[i[2]] = i[3];
    if (operation_of(i) != spv::OpTypeArray || !constants.contains(i[3])) return;
    const auto length = static_cast<std::int32_t>(constants[i[3]]);
    if (length <= 0) fail(label, fmt::format("an array is specialised to a length of {}", length));
  });
}

void replace_undefined(std::vector<std::uint32_t>& words) {
  for_each_instruction(std::span(words), [](std::span<std::uint32_t> i) {
    if (operation_of(i) == spv::OpUndef) i[0] = 3u << 16 | spv::OpConstantNull;
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
  check_lengths(words, label);
  replace_undefined(words);
  return words;
}

namespace {

/// Instructions of a module whose functions are all inlined.
std::uint64_t inlined_size(std::span<const std::uint32_t> spirv) {
  struct Function {
    std::uint64_t size = 0;
    std::vector<std::uint32_t> calls;
  };
  std::unordered_map<std::uint32_t, Function> functions;
  std::uint32_t entry = 0, current = 0;
  for_each_instruction(spirv, [&](std::span<const std::uint32_t> i) {
    if (operation_of(i) == spv::OpEntryPoint) entry = i[2];
    if (operation_of(i) == spv::OpFunction) current = i[2];
    if (current == 0) return;
    ++functions[current].size;
    if (operation_of(i) == spv::OpFunctionCall) functions[current].calls.push_back(i[3]);
  });
  std::unordered_map<std::uint32_t, std::uint64_t> known;
  const auto size_of = [&](const auto& self, std::uint32_t id) -> std::uint64_t {
    if (const auto found = known.find(id); found != known.end()) return found->second;
    std::uint64_t size = functions[id].size;
    for (const std::uint32_t callee : functions[id].calls) size = std::min(size + self(self, callee), UINT64_MAX / 2);
    return known[id] = size;
  };
  return size_of(size_of, entry);
}

/// Of a module that asks for signed zeros, infinities and NaN spirv-opt leaves floats alone; of another one it makes 0
/// of 0 * x.
std::vector<std::uint32_t> without_float_folding(std::span<const std::uint32_t> spirv) {
  std::vector<std::uint32_t> words(spirv.begin(), spirv.end());
  words.insert(words.begin() + rhi::spirv_header_words,
               {2u << 16 | spv::OpCapability, spv::CapabilitySignedZeroInfNanPreserve});
  return words;
}

/// Whether a function's result is a pointer.
bool returns_pointers(std::span<const std::uint32_t> spirv) {
  std::unordered_set<std::uint32_t> pointers;
  bool found = false;
  for_each_instruction(spirv, [&](std::span<const std::uint32_t> i) {
    if (operation_of(i) == spv::OpTypePointer) pointers.insert(i[1]);
    if (operation_of(i) == spv::OpFunction) found |= pointers.contains(i[1]);
  });
  return found;
}

}  // namespace

std::vector<std::uint32_t> with_values_for_variables(std::span<const std::uint32_t> spirv, const std::string& label) {
  // SPIRV-Tools 2023.1 takes such a function for a pointer there and crashes.
  const bool can_remove_dead_code = !returns_pointers(spirv);
  const auto values_for_variables = [&](spvtools::Optimizer& optimizer) {
    optimizer.RegisterPass(spvtools::CreateScalarReplacementPass(0));
    optimizer.RegisterPass(spvtools::CreateLocalAccessChainConvertPass());
    optimizer.RegisterPass(spvtools::CreateLocalSingleBlockLoadStoreElimPass());
    optimizer.RegisterPass(spvtools::CreateLocalSingleStoreElimPass());
    optimizer.RegisterPass(spvtools::CreateSSARewritePass());
    optimizer.RegisterPass(spvtools::CreateCCPPass());
    optimizer.RegisterPass(spvtools::CreateDeadBranchElimPass());
    if (can_remove_dead_code) optimizer.RegisterPass(spvtools::CreateAggressiveDCEPass(true));
  };
  std::vector<std::uint32_t> words =
      optimize(with_value_parameters(with_plain_copies(without_float_folding(spirv))), label, values_for_variables);
  // What is inlined has more values in place of variables, and more that all lanes have in common; too much of it takes
  // the C++ compiler minutes.
  constexpr std::uint64_t inlining_limit = 4000;
  if (inlined_size(words) <= inlining_limit) {
    words = optimize(words, label, [&](spvtools::Optimizer& optimizer) {
      // Functions with early returns are not inlined.
      optimizer.RegisterPass(spvtools::CreateMergeReturnPass());
      optimizer.RegisterPass(spvtools::CreateInlineExhaustivePass());
      optimizer.RegisterPass(spvtools::CreateEliminateDeadFunctionsPass());
      optimizer.RegisterPass(spvtools::CreatePrivateToLocalPass());
      values_for_variables(optimizer);
      optimizer.RegisterPass(spvtools::CreateBlockMergePass());
    });
  }
  replace_undefined(words);
  return words;
}

std::vector<std::uint32_t> with_marked_loops(std::span<const std::uint32_t> spirv) {
  std::vector<std::uint32_t> result(spirv.begin(), spirv.begin() + rhi::spirv_header_words);
  for_each_instruction(spirv, [&](std::span<const std::uint32_t> i) {
    if (operation_of(i) == spv::OpLoopMerge) result.push_back(1u << 16 | loop_mark);
    result.insert(result.end(), i.begin(), i.end());
  });
  return result;
}

}  // namespace tandem::cpu
