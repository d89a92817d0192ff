#include <fmt/format.h>

#include "rhi/spirv/names.hpp"
#include "rhi_cpu/translate/names/kernel_names.hpp"
#include "rhi_cpu/translate/printer.hpp"

namespace tandem::cpu {

using spirv_cross::SPIRExpression;
using spirv_cross::SPIRType;
using spirv_cross::SPIRVariable;

std::string Printer::texel_format(const Type& type) const {
  const char* name = texel_format_name(type.image.format);
  if (name == nullptr) fail("image format " + rhi::image_format_name(type.image.format));
  return fmt::format("k::TexelFormat::{}", name);
}

const char* Printer::image_shape(const Type& type) const {
  const bool arrayed = type.image.arrayed;
  switch (type.image.dim) {
    case spv::Dim1D:
      return arrayed ? "k::Shape::d1_array" : "k::Shape::d1";
    case spv::DimBuffer:
      return "k::Shape::d1";
    case spv::Dim2D:
      return arrayed ? "k::Shape::d2_array" : "k::Shape::d2";
    case spv::Dim3D:
      return "k::Shape::d3";
    case spv::DimCube:
      return arrayed ? "k::Shape::cube_array" : "k::Shape::cube";
    default:
      fail("an image of dimension " + rhi::dimension_name(type.image.dim));
  }
}

bool Printer::is_descriptor(const Type& type) const {
  return type.basetype == SPIRType::AccelerationStructure || type.basetype == SPIRType::Image ||
         type.basetype == SPIRType::Sampler || type.basetype == SPIRType::SampledImage;
}

const char* Printer::descriptor_target(const Type& type) const {
  if (is_combined(type)) return "k::SampledImage";
  if (type.basetype == SPIRType::Sampler) return "k::Sampler";
  return type.basetype == SPIRType::AccelerationStructure ? "k::TopLevel" : "k::Image";
}

std::string Printer::descriptor_member(const Type& type, const std::string& resource) const {
  const char* form = options_.robust ? "k::bound<{}>({}.data)" : "reinterpret_cast<const {}*>({}.data)";
  return fmt::format(fmt::runtime(form), descriptor_target(type), resource);
}

std::string Printer::descriptor_parameter(const Type& type) {
  return is_array(type) ? "const k::Resource*" : type_name(type);
}

std::string Printer::descriptor_value(std::uint32_t pointer_id) {
  const Type& type = get<Type>(pointee(expression_type_id(pointer_id)));
  if (is_array(type)) return value(pointer_id);
  // An element of an array of descriptors is a kernel::Resource; a variable points at what the host has bound; a
  // parameter is a value.
  const auto* variable = maybe_get<SPIRVariable>(pointer_id);
  if (variable != nullptr && variable->parameter != nullptr) return value(pointer_id);
  const std::string text = variable == nullptr ? descriptor_member(type, value(pointer_id)) : value(pointer_id);
  if (type.basetype == SPIRType::AccelerationStructure) return "k::accelerationStructureEXT{" + text + "}";
  return is_combined(type) ? "*" + text : text;
}

void Printer::refuse_sample(const Instruction& i, std::size_t mask) const {
  // What a mask of image operands can say of a storage image besides is about memory or about signs, which the types
  // have.
  if (i.operand_count() > mask && (i.operand(mask) & spv::ImageOperandsSampleMask) != 0)
    fail(rhi::instruction_name(i.op(), i.words()) + " of a sample");
}

void Printer::print_image_read(const Instruction& i) {
  refuse_sample(i, 2);
  const Type& image = type_of(i.operand(0));
  const Type& result = get<Type>(i.result_type());
  const std::string texel = fmt::format("k::image_load<{}, {}>({}{}, {})", texel_component(image), texel_format(image),
                                        lanes_argument(), value(i.operand(0)), value(i.operand(1)));
  define(i, result.vecsize == 1 ? texel + ".x" : fmt::format("{}({})", type_name(result), texel));
}

void Printer::print_image_write(const Instruction& i) {
  refuse_sample(i, 3);
  const std::uint32_t image_id = i.operand(0), coordinate = i.operand(1), texel_id = i.operand(2);
  const Type& image = type_of(image_id);
  const BaseType base = get<Type>(image.image.type).basetype;
  std::string texel = value_as(texel_id, base);
  for (std::uint32_t k = type_of(texel_id).vecsize; k < 4; ++k) texel += ", 0";
  statement(fmt::format("k::image_store<{}, {}>({}{}, {}, {}({}));", scalar_name(base), texel_format(image),
                        lanes_argument(), value(image_id), value(coordinate), numbers_name(base, 4), texel));
}

void Printer::print_image_size(const Instruction& i) {
  const bool is_scalar = get<Type>(i.result_type()).vecsize == 1;
  // OpImageQuerySizeLod has a level.
  const std::string level = i.operand_count() > 1 ? fmt::format(", k::uint({})", value(i.operand(1))) : "";
  define(i, fmt::format("{}(k::image_size<{}>({}{}){})", type_name(i.result_type()), image_shape(type_of(i.operand(0))),
                        value(i.operand(0)), level, is_scalar ? ".x" : ""));
}

void Printer::print_texel_pointer(const Instruction& i) {
  const Type& image = get<Type>(pointee(expression_type_id(i.operand(0))));
  const spv::ImageFormat format = image.image.format;
  const bool is_wide = format == spv::ImageFormatR64ui || format == spv::ImageFormatR64i;
  if (!is_wide && format != spv::ImageFormatR32ui && format != spv::ImageFormatR32i && format != spv::ImageFormatR32f)
    fail("OpImageTexelPointer into an image of format " + rhi::image_format_name(format));
  // It lives until the end of the expression that has the atomic operation.
  const std::string pointer = fmt::format("k::texel_pointer({}, {}, {}, k::NoTexel{{}})",
                                          descriptor_value(i.operand(0)), value(i.operand(1)), is_wide ? 8 : 4);
  addresses_[i.result()] = {.bytes = pointer, .resource = ""};
  set<SPIRExpression>(i.result(), pointer, i.result_type(), true);
}

}  // namespace tandem::cpu
