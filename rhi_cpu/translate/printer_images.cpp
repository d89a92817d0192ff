#include <fmt/format.h>

#include "rhi/texture.hpp"
#include "rhi_cpu/kernel/images.hpp"
#include "rhi_cpu/translate/printer.hpp"

namespace tandem::cpu {

using spirv_cross::SPIRExpression;
using spirv_cross::SPIRType;
using spirv_cross::SPIRVariable;

// A kernel reads Image::format, which is an rhi::TextureFormat.
static_assert(static_cast<std::uint32_t>(kernel::TexelFormat::rgba8_sint) ==
              static_cast<std::uint32_t>(rhi::TextureFormat::rgba8_sint));
static_assert(static_cast<std::uint32_t>(kernel::TexelFormat::rgba16_float) ==
              static_cast<std::uint32_t>(rhi::TextureFormat::rgba16_float));
static_assert(static_cast<std::uint32_t>(kernel::TexelFormat::rg32_float) ==
              static_cast<std::uint32_t>(rhi::TextureFormat::rg32_float));
static_assert(static_cast<std::uint32_t>(kernel::TexelFormat::rgba32_float) ==
              static_cast<std::uint32_t>(rhi::TextureFormat::rgba32_float));

std::string Printer::texel_format(const Type& type) const {
  switch (type.image.format) {
    case spv::ImageFormatUnknown:
      return "k::TexelFormat::of_the_image";
    case spv::ImageFormatRgba8:
      return "k::TexelFormat::rgba8_unorm";
    case spv::ImageFormatRgba8Snorm:
      return "k::TexelFormat::rgba8_snorm";
    case spv::ImageFormatRgba8ui:
      return "k::TexelFormat::rgba8_uint";
    case spv::ImageFormatRgba8i:
      return "k::TexelFormat::rgba8_sint";
    case spv::ImageFormatRgba16ui:
      return "k::TexelFormat::rgba16_uint";
    case spv::ImageFormatRgba16i:
      return "k::TexelFormat::rgba16_sint";
    case spv::ImageFormatRgba16f:
      return "k::TexelFormat::rgba16_float";
    case spv::ImageFormatR32ui:
      return "k::TexelFormat::r32_uint";
    case spv::ImageFormatR32i:
      return "k::TexelFormat::r32_sint";
    case spv::ImageFormatR32f:
      return "k::TexelFormat::r32_float";
    case spv::ImageFormatRg32ui:
      return "k::TexelFormat::rg32_uint";
    case spv::ImageFormatRg32i:
      return "k::TexelFormat::rg32_sint";
    case spv::ImageFormatRg32f:
      return "k::TexelFormat::rg32_float";
    case spv::ImageFormatRgba32ui:
      return "k::TexelFormat::rgba32_uint";
    case spv::ImageFormatRgba32i:
      return "k::TexelFormat::rgba32_sint";
    case spv::ImageFormatRgba32f:
      return "k::TexelFormat::rgba32_float";
    default:
      fail(fmt::format("SPIR-V image format {}", static_cast<std::uint32_t>(type.image.format)));
  }
}

bool Printer::is_descriptor(const Type& type) const {
  return type.basetype == SPIRType::AccelerationStructure || type.basetype == SPIRType::Image;
}

const char* Printer::descriptor_target(const Type& type) const {
  return type.basetype == SPIRType::Image ? "k::Image" : "k::TopLevel";
}

std::string Printer::descriptor_member(const Type& type, const std::string& resource) const {
  return fmt::format("reinterpret_cast<const {}*>({}.data)", descriptor_target(type), resource);
}

std::string Printer::descriptor_value(std::uint32_t pointer_id) {
  const Type& type = type_of(pointer_id);
  // An element of an array of descriptors is a kernel::Resource; a variable or a parameter is what it holds.
  const bool is_element = maybe_get<SPIRVariable>(pointer_id) == nullptr;
  const std::string text = is_element ? descriptor_member(type, value(pointer_id)) : value(pointer_id);
  return type.basetype == SPIRType::Image ? text : "k::accelerationStructureEXT{" + text + "}";
}

bool Printer::print_image(spv::Op op, Operands ops, std::uint32_t length) {
  // A mask of image operands follows; what it can say of a storage image is about memory or about signs, which the
  // types have.
  switch (op) {
    case spv::OpImageRead: {
      if (length > 4 && (ops[4] & spv::ImageOperandsSampleMask) != 0) fail("OpImageRead of a sample");
      const Type& image = type_of(ops[2]);
      const Type& result = get<Type>(ops[0]);
      const std::string texel =
          fmt::format("k::image_load<{}, {}>({}, {})", scalar_name(get<Type>(image.image.type).basetype),
                      texel_format(image), value(ops[2]), value(ops[3]));
      define(ops[0], ops[1], result.vecsize == 1 ? texel + ".x" : fmt::format("{}({})", type_name(result), texel));
      return true;
    }
    case spv::OpImageWrite: {
      if (length > 3 && (ops[3] & spv::ImageOperandsSampleMask) != 0) fail("OpImageWrite of a sample");
      const Type& image = type_of(ops[0]);
      const BaseType base = get<Type>(image.image.type).basetype;
      const std::uint32_t components = type_of(ops[2]).vecsize;
      std::string texel = value_as(ops[2], base);
      for (std::uint32_t i = components; i < 4; ++i) texel += ", 0";
      statement(fmt::format("k::image_store<{}, {}>({}, {}, {}({}));", scalar_name(base), texel_format(image),
                            value(ops[0]), value(ops[1]), vector_name(base, 4), texel));
      return true;
    }
    case spv::OpImageQuerySize:
      define(ops[0], ops[1],
             get<Type>(ops[0]).vecsize == 1 ? fmt::format("{}(k::image_size({}).x)", type_name(ops[0]), value(ops[2]))
                                            : fmt::format("{}(k::image_size({}))", type_name(ops[0]), value(ops[2])));
      return true;
    case spv::OpImageTexelPointer: {
      const Type& image = get<Type>(pointee(expression_type_id(ops[2])));
      if (image.image.format != spv::ImageFormatR32ui && image.image.format != spv::ImageFormatR32i &&
          image.image.format != spv::ImageFormatR32f)
        fail("OpImageTexelPointer into other than r32ui, r32i and r32f images");
      // It lives until the end of the expression that has the atomic operation.
      const std::string pointer =
          fmt::format("k::texel_pointer({}, {}, k::NoTexel{{}})", descriptor_value(ops[2]), value(ops[3]));
      addresses_[ops[1]] = {.bytes = pointer, .resource = ""};
      set<SPIRExpression>(ops[1], pointer, ops[0], true);
      return true;
    }
    default:
      return false;
  }
}

}  // namespace tandem::cpu
