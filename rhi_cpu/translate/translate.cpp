#include "rhi_cpu/translate/translate.hpp"

#include <exception>
#include <vector>

#include "rhi/error.hpp"
#include "rhi/shader_reflection.hpp"
#include "rhi_cpu/translate/groups/places.hpp"
#include "rhi_cpu/translate/prepare.hpp"
#include "rhi_cpu/translate/printer.hpp"

namespace tandem::cpu {

namespace {

/// A module that spirv-opt cannot take has a scalar form all the same.
std::vector<std::uint32_t> for_lanes(std::span<const std::uint32_t> words, const std::string& label) {
  try {
    return with_values_for_variables(words, label);
  } catch (const std::exception& error) {
    throw rhi::Error(rhi::ErrorCode::unsupported, label, std::string("there is no wide form of it: ") + error.what());
  }
}

}  // namespace

Translation translate(std::span<const std::uint32_t> spirv, const std::string& label, const TranslateOptions& options) {
  std::vector<std::uint32_t> words = prepare(spirv, label, options.specialization);
  const rhi::ShaderReflection reflection = rhi::reflect_valid(words, label);
  if (options.lanes != 0) words = for_lanes(words, label);
  if (options.watched) words = with_marked_loops(words);
  try {
    // In the wide form the masks say who meets.
    const bool is_marked = options.lanes == 0 && has_meetings(words);
    const MarkedModule module = is_marked ? with_marked_places(words) : MarkedModule{.words = words};
    return {Printer(module, label, reflection, options).compile()};
  } catch (const rhi::Error&) {
    throw;
  } catch (const std::exception& error) {
    throw rhi::Error(rhi::ErrorCode::unsupported, label,
                     std::string("the SPIR-V cannot be translated: ") + error.what());
  }
}

}  // namespace tandem::cpu
