#include "rhi/pipeline.hpp"

#include <algorithm>
#include <string>
#include <tuple>

#include "rhi/error.hpp"

namespace tandem::rhi {
namespace {

bool is_declared_alike(const ShaderBinding& a, const ShaderBinding& b) {
  return a.kind == b.kind && a.count == b.count && a.dimension == b.dimension && a.format == b.format;
}

void add(PipelineInterface& interface, const ShaderBinding& binding, std::string_view shader, std::string_view label) {
  const auto place = std::tie(binding.set, binding.binding);
  const auto found = std::lower_bound(
      interface.bindings.begin(), interface.bindings.end(), place,
      [](const ShaderBinding& each, const auto& wanted) { return std::tie(each.set, each.binding) < wanted; });
  if (found == interface.bindings.end() || std::tie(found->set, found->binding) != place) {
    interface.bindings.insert(found, binding);
    return;
  }
  if (!is_declared_alike(*found, binding))
    throw Error(ErrorCode::invalid_argument, label,
                "the shader '" + std::string(shader) + "' declares set " + std::to_string(binding.set) + " binding " +
                    std::to_string(binding.binding) + " ('" + binding.name +
                    "') otherwise than another shader does ('" + found->name + "')");
  found->writable = found->writable || binding.writable;
}

}  // namespace

PipelineInterface combined_interface(std::span<const ShaderModuleHandle> shaders, std::string_view label,
                                     std::uint32_t unsized_array_length) {
  PipelineInterface interface;
  interface.unsized_array_length = unsized_array_length;
  for (const ShaderModuleHandle& shader : shaders) {
    const ShaderReflection& reflection = shader->reflection();
    for (const ShaderBinding& binding : reflection.bindings) add(interface, binding, shader->label(), label);
    interface.push_constant_size = std::max(interface.push_constant_size, reflection.push_constant_size);
  }
  return interface;
}

}  // namespace tandem::rhi
