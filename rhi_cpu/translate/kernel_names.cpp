#include "rhi_cpu/translate/kernel_names.hpp"

#include <cstddef>
#include <iterator>

#include "rhi/texture.hpp"
#include "rhi_cpu/kernel/images.hpp"

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
    {spv::ImageFormatRgba8, TextureFormat::rgba8_unorm, TexelFormat::rgba8_unorm, "rgba8_unorm"},
    {spv::ImageFormatRgba8Snorm, TextureFormat::rgba8_snorm, TexelFormat::rgba8_snorm, "rgba8_snorm"},
    {spv::ImageFormatRgba8ui, TextureFormat::rgba8_uint, TexelFormat::rgba8_uint, "rgba8_uint"},
    {spv::ImageFormatRgba8i, TextureFormat::rgba8_sint, TexelFormat::rgba8_sint, "rgba8_sint"},
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
    default:
      return nullptr;
  }
}

const char* texel_format_name(spv::ImageFormat format) {
  if (format == spv::ImageFormatUnknown) return "of_the_image";
  for (const FormatNames& each : formats)
    if (each.spirv == format) return each.kernel_name;
  return nullptr;
}

}  // namespace tandem::cpu
