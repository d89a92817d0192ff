#include "rhi/shader_module.hpp"

#include "rhi/entry_point.hpp"
#include "rhi/spirv_validation.hpp"

namespace tandem::rhi {
namespace {

std::vector<std::uint32_t> words_of(const ShaderModuleDesc& desc) {
  if (!desc.known_valid) check_spirv(desc.spirv, desc.label);
  return with_one_entry_point(desc.spirv, desc.entry_point, desc.label);
}

}  // namespace

ShaderModule::ShaderModule(const ShaderModuleDesc& desc)
    : label_(desc.label), spirv_(words_of(desc)), reflection_(reflect_valid(spirv_, label_)) {}

}  // namespace tandem::rhi
