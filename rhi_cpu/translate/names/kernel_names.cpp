#include "rhi_cpu/translate/names/kernel_names.hpp"

#include <cstddef>
#include <iterator>

#include "rhi/texture.hpp"
#include "rhi_cpu/kernel/texels.hpp"

namespace tandem::cpu {
namespace {

using kernel::TexelFormat;
using rhi::TextureFormat;

struct FormatNames {
  spv::ImageFormat spirv;
  TextureFormat rhi;
  TexelFormat kernel;
  const char* kernel_name;
};

constexpr FormatNames formats[] = {
    {spv::ImageFormatR8, TextureFormat::r8_unorm, TexelFormat::r8_unorm, "r8_unorm"},
    {spv::ImageFormatR8Snorm, TextureFormat::r8_snorm, TexelFormat::r8_snorm, "r8_snorm"},
    {spv::ImageFormatR8ui, TextureFormat::r8_uint, TexelFormat::r8_uint, "r8_uint"},
    {spv::ImageFormatR8i, TextureFormat::r8_sint, TexelFormat::r8_sint, "r8_sint"},
    {spv::ImageFormatRg8, TextureFormat::rg8_unorm, TexelFormat::rg8_unorm, "rg8_unorm"},
    {spv::ImageFormatRg8Snorm, TextureFormat::rg8_snorm, TexelFormat::rg8_snorm, "rg8_snorm"},
    {spv::ImageFormatRg8ui, TextureFormat::rg8_uint, TexelFormat::rg8_uint, "rg8_uint"},
    {spv::ImageFormatRg8i, TextureFormat::rg8_sint, TexelFormat::rg8_sint, "rg8_sint"},
    {spv::ImageFormatRgba8, TextureFormat::rgba8_unorm, TexelFormat::rgba8_unorm, "rgba8_unorm"},
    {spv::ImageFormatRgba8Snorm, TextureFormat::rgba8_snorm, TexelFormat::rgba8_snorm, "rgba8_snorm"},
    {spv::ImageFormatRgba8ui, TextureFormat::rgba8_uint, TexelFormat::rgba8_uint, "rgba8_uint"},
    {spv::ImageFormatRgba8i, TextureFormat::rgba8_sint, TexelFormat::rgba8_sint, "rgba8_sint"},
    {spv::ImageFormatR16, TextureFormat::r16_unorm, TexelFormat::r16_unorm, "r16_unorm"},
    {spv::ImageFormatR16Snorm, TextureFormat::r16_snorm, TexelFormat::r16_snorm, "r16_snorm"},
    {spv::ImageFormatR16ui, TextureFormat::r16_uint, TexelFormat::r16_uint, "r16_uint"},
    {spv::ImageFormatR16i, TextureFormat::r16_sint, TexelFormat::r16_sint, "r16_sint"},
    {spv::ImageFormatR16f, TextureFormat::r16_float, TexelFormat::r16_float, "r16_float"},
    {spv::ImageFormatRg16, TextureFormat::rg16_unorm, TexelFormat::rg16_unorm, "rg16_unorm"},
    {spv::ImageFormatRg16Snorm, TextureFormat::rg16_snorm, TexelFormat::rg16_snorm, "rg16_snorm"},
    {spv::ImageFormatRg16ui, TextureFormat::rg16_uint, TexelFormat::rg16_uint, "rg16_uint"},
    {spv::ImageFormatRg16i, TextureFormat::rg16_sint, TexelFormat::rg16_sint, "rg16_sint"},
    {spv::ImageFormatRg16f, TextureFormat::rg16_float, TexelFormat::rg16_float, "rg16_float"},
    {spv::ImageFormatRgba16, TextureFormat::rgba16_unorm, TexelFormat::rgba16_unorm, "rgba16_unorm"},
    {spv::ImageFormatRgba16Snorm, TextureFormat::rgba16_snorm, TexelFormat::rgba16_snorm, "rgba16_snorm"},
    {spv::ImageFormatRgba16ui, TextureFormat::rgba16_uint, TexelFormat::rgba16_uint, "rgba16_uint"},
    {spv::ImageFormatRgba16i, TextureFormat::rgba16_sint, TexelFormat::rgba16_sint, "rgba16_sint"},
    {spv::ImageFormatRgba16f, TextureFormat::rgba16_float, TexelFormat::rgba16_float, "rgba16_float"},
    {spv::ImageFormatR32ui, TextureFormat::r32_uint, TexelFormat::r32_uint, "r32_uint"},
    {spv::ImageFormatR32i, TextureFormat::r32_sint, TexelFormat::r32_sint, "r32_sint"},
    {spv::ImageFormatR32f, TextureFormat::r32_float, TexelFormat::r32_float, "r32_float"},
    {spv::ImageFormatRg32ui, TextureFormat::rg32_uint, TexelFormat::rg32_uint, "rg32_uint"},
    {spv::ImageFormatRg32i, TextureFormat::rg32_sint, TexelFormat::rg32_sint, "rg32_sint"},
    {spv::ImageFormatRg32f, TextureFormat::rg32_float, TexelFormat::rg32_float, "rg32_float"},
    {spv::ImageFormatRgba32ui, TextureFormat::rgba32_uint, TexelFormat::rgba32_uint, "rgba32_uint"},
    {spv::ImageFormatRgba32i, TextureFormat::rgba32_sint, TexelFormat::rgba32_sint, "rgba32_sint"},
    {spv::ImageFormatRgba32f, TextureFormat::rgba32_float, TexelFormat::rgba32_float, "rgba32_float"},
    {spv::ImageFormatR64ui, TextureFormat::r64_uint, TexelFormat::r64_uint, "r64_uint"},
    {spv::ImageFormatR64i, TextureFormat::r64_sint, TexelFormat::r64_sint, "r64_sint"},
    {spv::ImageFormatRgb10A2, TextureFormat::rgb10a2_unorm, TexelFormat::rgb10a2_unorm, "rgb10a2_unorm"},
    {spv::ImageFormatRgb10a2ui, TextureFormat::rgb10a2_uint, TexelFormat::rgb10a2_uint, "rgb10a2_uint"},
    {spv::ImageFormatR11fG11fB10f, TextureFormat::rg11b10_float, TexelFormat::rg11b10_float, "rg11b10_float"},
    {spv::ImageFormatUnknown, TextureFormat::rgba8_srgb, TexelFormat::rgba8_srgb, "rgba8_srgb"},
    {spv::ImageFormatUnknown, TextureFormat::bgra8_unorm, TexelFormat::bgra8_unorm, "bgra8_unorm"},
    {spv::ImageFormatUnknown, TextureFormat::d16_unorm, TexelFormat::d16_unorm, "d16_unorm"},
    {spv::ImageFormatUnknown, TextureFormat::d32_float, TexelFormat::d32_float, "d32_float"},
};

/// A kernel reads Image::format, which is an rhi::TextureFormat, as a kernel::TexelFormat.
constexpr bool have_equal_numbers() {
  for (std::size_t i = 0; i < std::size(formats); ++i) {
    if (static_cast<std::size_t>(formats[i].rhi) != i) return false;
    if (static_cast<std::size_t>(formats[i].kernel) != i) return false;
  }
  return true;
}
static_assert(have_equal_numbers());
static_assert(std::size(formats) == static_cast<std::size_t>(TexelFormat::of_the_image), "every format is listed");

}  // namespace

const char* stage_name(rhi::ShaderStage stage) {
  switch (stage) {
    case rhi::ShaderStage::compute:
      return "compute";
    case rhi::ShaderStage::ray_generation:
      return "ray_generation";
    case rhi::ShaderStage::any_hit:
      return "any_hit";
    case rhi::ShaderStage::closest_hit:
      return "closest_hit";
    case rhi::ShaderStage::miss:
      return "miss";
    case rhi::ShaderStage::intersection:
      return "intersection";
    case rhi::ShaderStage::callable:
      return "callable";
  }
  return nullptr;
}

const char* resource_kind_name(rhi::BindingKind kind) {
  switch (kind) {
    case rhi::BindingKind::uniform_buffer:
      return "uniform_buffer";
    case rhi::BindingKind::storage_buffer:
      return "storage_buffer";
    case rhi::BindingKind::acceleration_structure:
      return "acceleration_structure";
    case rhi::BindingKind::storage_image:
      return "storage_image";
    case rhi::BindingKind::sampled_image:
      return "sampled_image";
    case rhi::BindingKind::sampler:
      return "sampler";
    case rhi::BindingKind::combined_image_sampler:
      return "combined_image_sampler";
    case rhi::BindingKind::uniform_texel_buffer:
      return "uniform_texel_buffer";
    case rhi::BindingKind::storage_texel_buffer:
      return "storage_texel_buffer";
  }
  return nullptr;
}

const char* texel_format_name(spv::ImageFormat format) {
  if (format == spv::ImageFormatUnknown) return "of_the_image";
  for (const FormatNames& each : formats)
    if (each.spirv == format) return each.kernel_name;
  return nullptr;
}

}  // namespace tandem::cpu
