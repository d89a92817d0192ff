#include "program/execute/specialization.hpp"

#include <algorithm>
#include <unordered_map>

#include <fmt/format.h>
#include <spirv-tools/optimizer.hpp>

#include "rhi/error.hpp"

namespace tandem::program {

std::vector<std::uint32_t> specialized(const rhi::ShaderModule& module,
                                       std::span<const rhi::SpecializationValue> values) {
  std::unordered_map<std::uint32_t, std::vector<std::uint32_t>> defaults;
  for (const rhi::SpecializationValue& each : values) {
    const auto& declared = module.reflection().specialization_constants;
    const auto constant = std::ranges::find(declared, each.id, &rhi::SpecializationConstant::id);
    if (constant == declared.end())
      throw rhi::Error(rhi::ErrorCode::invalid_argument, module.label(),
                       fmt::format("the shader has no specialisation constant {}", each.id));
    std::vector<std::uint32_t>& words = defaults[each.id];
    words = {static_cast<std::uint32_t>(each.value)};
    if (constant->width == 64) words.push_back(static_cast<std::uint32_t>(each.value >> 32));
  }
  spvtools::Optimizer optimizer(SPV_ENV_UNIVERSAL_1_6);
  optimizer.RegisterPass(spvtools::CreateSetSpecConstantDefaultValuePass(defaults));
  std::vector<std::uint32_t> result;
  spvtools::OptimizerOptions options;
  options.set_run_validator(false);  // the module has passed it
  if (!optimizer.Run(module.spirv().data(), module.spirv().size(), &result, options))
    throw rhi::Error(rhi::ErrorCode::invalid_argument, module.label(),
                     "SPIRV-Tools cannot set the values of specialisation constants");
  return result;
}

}  // namespace tandem::program
