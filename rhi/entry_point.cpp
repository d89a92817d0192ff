#include "rhi/entry_point.hpp"

#include <algorithm>
#include <cstring>
#include <string>
#include <unordered_set>

#include <spirv-tools/optimizer.hpp>

#include "rhi/error.hpp"
#include "rhi/spirv/words.hpp"

namespace tandem::rhi {
namespace {

using Instruction = std::span<const std::uint32_t>;

/// Of an OpEntryPoint.
std::string name_of(Instruction i) {
  const Instruction text = i.subspan(3);
  const auto* characters = reinterpret_cast<const char*>(text.data());
  return {characters, strnlen(characters, text.size_bytes())};
}

struct EntryPoint {
  std::string name;
  std::uint32_t function;
};

std::vector<EntryPoint> entry_points(std::span<const std::uint32_t> spirv) {
  std::vector<EntryPoint> found;
  for_each_instruction(spirv, [&](Instruction i) {
    if (operation_of(i) == spv::OpEntryPoint) found.push_back({name_of(i), i[2]});
  });
  return found;
}

std::vector<std::uint32_t> without_dead_functions(std::vector<std::uint32_t> spirv, std::string_view label) {
  spvtools::Optimizer optimizer(SPV_ENV_UNIVERSAL_1_6);
  optimizer.RegisterPass(spvtools::CreateEliminateDeadFunctionsPass());
  spvtools::OptimizerOptions options;
  options.set_run_validator(false);
  std::vector<std::uint32_t> result;
  if (!optimizer.Run(spirv.data(), spirv.size(), &result, options))
    throw Error(ErrorCode::invalid_argument, label, "the SPIR-V of one entry point cannot be taken out of the module");
  return result;
}

}  // namespace

std::vector<std::uint32_t> with_one_entry_point(std::span<const std::uint32_t> spirv, std::string_view name,
                                                std::string_view label) {
  const std::vector<EntryPoint> all = entry_points(spirv);
  std::string names;
  for (const EntryPoint& each : all) names += (names.empty() ? "" : ", ") + each.name;
  if (name.empty() && all.size() != 1)
    throw Error(ErrorCode::invalid_argument, label,
                all.empty() ? "the SPIR-V module has no entry point"
                            : "the SPIR-V module has several entry points, of which one must be named: " + names);
  const auto chosen =
      std::find_if(all.begin(), all.end(), [&](const EntryPoint& each) { return name.empty() || each.name == name; });
  if (chosen == all.end())
    throw Error(ErrorCode::invalid_argument, label,
                "the SPIR-V module has no entry point '" + std::string(name) + "', but " + names);
  if (all.size() == 1) return {spirv.begin(), spirv.end()};

  std::vector<std::uint32_t> result(spirv.begin(), spirv.begin() + spirv_header_words);
  std::unordered_set<std::uint32_t> removed;
  for_each_instruction(spirv, [&](Instruction i) {
    const spv::Op op = operation_of(i);
    bool keep = true;
    if (op == spv::OpEntryPoint) {
      keep = i[2] == chosen->function && name_of(i) == chosen->name;
      if (!keep && i[2] != chosen->function) removed.insert(i[2]);
    }
    if (op == spv::OpExecutionMode || op == spv::OpExecutionModeId) keep = !removed.contains(i[1]);
    if (keep) result.insert(result.end(), i.begin(), i.end());
  });
  return without_dead_functions(std::move(result), label);
}

}  // namespace tandem::rhi
