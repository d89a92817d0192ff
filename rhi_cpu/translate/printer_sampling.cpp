// Sampled images and samplers.

#include <utility>

#include <fmt/format.h>

#include "rhi/spirv/names.hpp"
#include "rhi_cpu/translate/printer.hpp"

namespace tandem::cpu {

using spirv_cross::SPIRType;

namespace {

// Operands of an instruction that samples; the mask of image operands comes behind those that it has.
constexpr std::size_t texture = 0;
constexpr std::size_t coordinate = 1;
constexpr std::size_t reference = 2;  ///< a depth, or the component of a gather

/// Bits of a mask of image operands that are about memory, or about signs, which the types have, and how many operands
/// each has.
struct IgnoredOperand {
  std::uint32_t bit;
  std::size_t operand_count;
};
constexpr IgnoredOperand ignored_operands[] = {
    {spv::ImageOperandsMakeTexelAvailableKHRMask, 1},
    {spv::ImageOperandsMakeTexelVisibleKHRMask, 1},
    {spv::ImageOperandsNonPrivateTexelKHRMask, 0},
    {spv::ImageOperandsVolatileTexelKHRMask, 0},
    {spv::ImageOperandsSignExtendMask, 0},
    {spv::ImageOperandsZeroExtendMask, 0},
    {spv::ImageOperandsNontemporalMask, 0},
};

bool is_projective(spv::Op op) {
  return op == spv::OpImageSampleProjExplicitLod || op == spv::OpImageSampleProjDrefExplicitLod;
}

}  // namespace

ImageOperands Printer::image_operands(const Instruction& i, std::size_t mask) const {
  ImageOperands operands;
  if (i.operand_count() <= mask) return operands;
  std::uint32_t bits = i.operand(mask);
  std::size_t next = mask + 1;
  // Operands stand in the order of their bits.
  const auto take = [&](std::uint32_t bit, std::uint32_t& operand) {
    if ((bits & bit) != 0) operand = i.operand(next++);
    bits &= ~bit;
  };
  const bool has_gradients = (bits & spv::ImageOperandsGradMask) != 0;
  take(spv::ImageOperandsLodMask, operands.detail);
  take(spv::ImageOperandsGradMask, operands.dx);
  if (has_gradients) operands.dy = i.operand(next++);
  take(spv::ImageOperandsConstOffsetMask, operands.offset);
  take(spv::ImageOperandsOffsetMask, operands.offset);
  take(spv::ImageOperandsConstOffsetsMask, operands.offsets);
  take(spv::ImageOperandsMinLodMask, operands.least_detail);
  for (const IgnoredOperand& each : ignored_operands) bits &= ~each.bit;
  if (bits != 0) fail(fmt::format("{} with image operands {:#x}", rhi::instruction_name(i.op(), i.words()), bits));
  return operands;
}

std::string Printer::lookup(const Instruction& i, std::size_t mask) {
  const ImageOperands operands = image_operands(i, mask);
  std::string text = fmt::format("k::{}{}<{}>({})", is_projective(i.op()) ? "projected" : "lookup",
                                 mode_ == Mode::wide ? "_of_lanes" : "", image_shape(type_of(i.operand(texture))),
                                 value(i.operand(coordinate)));
  if (operands.detail != 0)
    text +=
        fmt::format(".at_detail({})", varies(operands.detail) ? value(operands.detail) : common_value(operands.detail));
  if (operands.dx != 0) text += fmt::format(".with_gradients({}, {})", value(operands.dx), value(operands.dy));
  if (operands.least_detail != 0) text += fmt::format(".not_finer_than({})", value(operands.least_detail));
  if (operands.offset != 0) text += fmt::format(".shifted({})", common_value(operands.offset));
  return text;
}

std::string Printer::common_value(std::uint32_t id) {
  const Mode before = std::exchange(mode_, mode_ == Mode::wide ? Mode::common : mode_);
  std::string text = value(id);
  mode_ = before;
  return text;
}

/// In lanes that have the image in common. What chooses texels for all lanes at once, and gradients, they have not got
/// each its own.
bool Printer::is_wide_image_operation(const Instruction& i) {
  const Type& image = type_of(i.operand(texture));
  const BaseType base = get<Type>(image.image.type).basetype;
  if (varies(i.operand(texture))) return false;
  if (base != SPIRType::Float && base != SPIRType::Int && base != SPIRType::UInt) return false;
  if (i.op() == spv::OpImageRead || i.op() == spv::OpImageWrite) return true;
  const bool is_gather = i.op() == spv::OpImageGather, is_fetch = i.op() == spv::OpImageFetch;
  const ImageOperands operands = image_operands(i, is_gather ? 3 : 2);
  const bool has_own_operands = operands.dx != 0 || operands.least_detail != 0 || varies(operands.offset) ||
                                varies(operands.offsets) || (is_fetch && varies(operands.detail)) ||
                                (is_gather && varies(i.operand(reference)));
  return !has_own_operands && (is_fetch || image.image.dim != spv::DimCube);
}

std::string Printer::texel_component(const Type& image) const {
  return scalar_name(get<Type>(image.image.type).basetype);
}

void Printer::print_sample(const Instruction& i) {
  samples_ = true;
  const Type& image = type_of(i.operand(texture));
  define(i, fmt::format("k::sample<{}, {}>({}{}, {})", texel_component(image), image_shape(image), lanes_argument(),
                        value(i.operand(texture)), lookup(i, 2)));
}

void Printer::print_sample_compare(const Instruction& i) {
  samples_ = true;
  const Type& image = type_of(i.operand(texture));
  std::string depth = value(i.operand(reference));
  if (is_projective(i.op())) {
    // The divisor stands behind the coordinates of the sides.
    const std::uint32_t sides = image.image.dim == spv::Dim1D ? 1 : image.image.dim == spv::Dim2D ? 2 : 3;
    const std::uint32_t divided = i.operand(coordinate);
    depth += " / " + element(value(divided), type_of(divided), sides);
  }
  define(i, fmt::format("k::sample_compare<{}>({}, {}, {})", image_shape(image), value(i.operand(texture)),
                        lookup(i, 3), depth));
}

void Printer::print_gather(const Instruction& i) {
  samples_ = true;
  const Type& image = type_of(i.operand(texture));
  const std::uint32_t offsets = image_operands(i, 3).offsets;
  const std::string more = offsets != 0 ? ", &" + common_value(offsets) : "";
  if (i.op() == spv::OpImageDrefGather)
    define(i, fmt::format("k::gather_compare<{}>({}, {}, {}{})", image_shape(image), value(i.operand(texture)),
                          lookup(i, 3), value(i.operand(reference)), more));
  else
    define(i, fmt::format("k::gather<{}, {}>({}, {}, int({}){})", texel_component(image), image_shape(image),
                          value(i.operand(texture)), lookup(i, 3), common_value(i.operand(reference)), more));
}

void Printer::print_fetch(const Instruction& i) {
  samples_ = true;
  const ImageOperands operands = image_operands(i, 2);
  std::string more;
  if (operands.detail != 0 || operands.offset != 0)
    more += operands.detail != 0 ? fmt::format(", k::uint({})", common_value(operands.detail)) : ", 0u";
  if (operands.offset != 0) more += fmt::format(", k::widened<k::ivec3>({})", common_value(operands.offset));
  define(i, fmt::format("k::fetch<{}>({}{}, {}{})", texel_component(type_of(i.operand(texture))), lanes_argument(),
                        value(i.operand(texture)), value(i.operand(coordinate)), more));
}

bool Printer::is_combined(const Type& type) const {
  return type.basetype == SPIRType::SampledImage && type.image.dim != spv::DimBuffer;
}

void Printer::print_sampled_image(const Instruction& i) {
  define(i, fmt::format("k::SampledImage{{{}, {}}}", value(i.operand(0)), value(i.operand(1))));
}

void Printer::print_image_of(const Instruction& i) {
  define(i, value(i.operand(texture)) + (is_combined(type_of(i.operand(texture))) ? ".image" : ""));
}

void Printer::print_level_count(const Instruction& i) {
  define(i, fmt::format("{}({}->level_count)", type_name(i.result_type()), value(i.operand(0))));
}

}  // namespace tandem::cpu
