#pragma once

#include <spirv_cross/spirv.hpp>

#include "rhi/shader_reflection.hpp"

/// How the headers of rhi_cpu/kernel/, in which a translated shader compiles, name what the rhi and SPIR-V enumerate.
namespace tandem::cpu {

/// An enumerator of kernel::Stage.
const char* stage_name(rhi::ShaderStage stage);

/// An enumerator of kernel::ResourceKind; null for what kernels cannot be given.
const char* resource_kind_name(rhi::BindingKind kind);

/// An enumerator of kernel::TexelFormat; null for a format that kernels do not read or write.
const char* texel_format_name(spv::ImageFormat format);

}  // namespace tandem::cpu
