#include "program/amber/value/data_type.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <utility>

#include "base/error.hpp"

namespace tandem::program::amber {
namespace {

constexpr std::array<std::pair<std::string_view, ScalarType>, 11> scalar_names = {{{"int8", ScalarType::int8},
                                                                                   {"uint8", ScalarType::uint8},
                                                                                   {"int16", ScalarType::int16},
                                                                                   {"uint16", ScalarType::uint16},
                                                                                   {"int32", ScalarType::int32},
                                                                                   {"uint32", ScalarType::uint32},
                                                                                   {"int64", ScalarType::int64},
                                                                                   {"uint64", ScalarType::uint64},
                                                                                   {"float16", ScalarType::float16},
                                                                                   {"float", ScalarType::float32},
                                                                                   {"double", ScalarType::float64}}};

constexpr std::uint64_t largest_size = std::uint64_t{2} << 30;
constexpr std::uint64_t most_scalars = 1 << 20;  // of one type: more are items of a buffer

std::optional<ScalarType> parse_scalar(std::string_view word) {
  for (const auto& [name, scalar] : scalar_names)
    if (name == word) return scalar;
  return std::nullopt;
}

bool is_dimension(char c) { return c >= '2' && c <= '4'; }

/// A type without brackets.
std::optional<DataType> parse_element(std::string_view word) {
  DataType type;
  if (const auto scalar = parse_scalar(word)) {
    type.scalar = *scalar;
    return type;
  }
  const std::size_t bracket = word.find('<');
  if (bracket != std::string_view::npos && word.ends_with('>')) {
    const std::string_view shape = word.substr(0, bracket);
    const auto scalar = parse_scalar(word.substr(bracket + 1, word.size() - bracket - 2));
    if (!scalar) return std::nullopt;
    type.scalar = *scalar;
    if (shape.size() == 4 && shape.starts_with("vec") && is_dimension(shape[3])) {
      type.rows = static_cast<std::uint32_t>(shape[3] - '0');
      return type;
    }
    if (shape.size() == 6 && shape.starts_with("mat") && is_dimension(shape[3]) && shape[4] == 'x' &&
        is_dimension(shape[5]) && is_floating(*scalar)) {
      type.columns = static_cast<std::uint32_t>(shape[3] - '0');
      type.rows = static_cast<std::uint32_t>(shape[5] - '0');
      return type;
    }
    return std::nullopt;
  }
  if (std::optional<Texel> texel = parse_texel(word)) {
    const ValueType value = value_type_of(*texel);
    type.scalar = value.scalar;
    type.rows = value.rows;
    type.texel = std::move(texel);
    return type;
  }
  return std::nullopt;
}

std::uint64_t round_up(std::uint64_t value, std::uint64_t multiple) {
  return (value + multiple - 1) / multiple * multiple;
}

std::uint32_t narrow(std::uint64_t size, std::string_view name) {
  if (size > largest_size) throw Error(fmt::format("the type {} has more than 2 GiB", name));
  return static_cast<std::uint32_t>(size);
}

/// A type with its layout and what its offset has to be a multiple of.
struct Aligned {
  ValueType type;
  std::uint64_t alignment = 4;
};

class Rules {
 public:
  explicit Rules(Layout layout) : layout_(layout) {}

  /// @param member whose strides count; null for the type of a buffer
  Aligned apply(const DataType& type, const StructMember* member) const {
    if (!type.is_array) return apply_element(type, member);
    const Aligned element = apply_element(type, member);
    Aligned array;
    array.alignment = std::max<std::uint64_t>(element.alignment, layout_ == Layout::std140 ? 16 : 1);
    std::uint64_t stride = round_up(element.type.size, array.alignment);
    if (member != nullptr && member->array_stride) {
      if (*member->array_stride < element.type.size)
        throw Error(fmt::format("ARRAY_STRIDE {} is smaller than the {} bytes of an element of {}",
                                *member->array_stride, element.type.size, member->name));
      stride = *member->array_stride;
    }
    array.type = make_array(element.type, type.count, narrow(stride, describe(element.type)));
    return array;
  }

 private:
  Aligned apply_element(const DataType& type, const StructMember* member) const {
    if (type.structure) return apply_struct(*type.structure);
    const std::uint64_t scalar = size_of(type.scalar);
    const std::uint64_t vector_alignment = layout_ == Layout::scalar ? scalar
                                           : type.rows == 3          ? 4 * scalar
                                                                     : type.rows * scalar;
    if (type.columns == 1) return {make_type(type.scalar, type.rows), vector_alignment};
    Aligned matrix;
    matrix.alignment = std::max<std::uint64_t>(vector_alignment, layout_ == Layout::std140 ? 16 : 1);
    std::uint64_t stride = round_up(type.rows * scalar, matrix.alignment);
    if (member != nullptr && member->matrix_stride) {
      if (*member->matrix_stride < type.rows * scalar)
        throw Error(fmt::format("MATRIX_STRIDE {} is smaller than the {} bytes of a column of {}",
                                *member->matrix_stride, type.rows * scalar, member->name));
      stride = *member->matrix_stride;
    }
    matrix.type.kind = ValueType::Kind::matrix;
    matrix.type.scalar = type.scalar;
    matrix.type.rows = type.rows;
    matrix.type.columns = type.columns;
    matrix.type.stride = static_cast<std::uint32_t>(stride);
    // The last column is as large as the others, so that what follows keeps its alignment.
    matrix.type.size = stride * type.columns;
    return matrix;
  }

  Aligned apply_struct(const Struct& declared) const {
    Aligned result;
    result.type.kind = ValueType::Kind::structure;
    result.type.name = declared.name;
    result.alignment = layout_ == Layout::std140 ? 16 : 1;
    std::uint64_t end = 0;
    for (const StructMember& member : declared.members) {
      const Aligned laid_out = apply(member.type, &member);
      std::uint64_t offset = round_up(end, laid_out.alignment);
      if (member.offset) {
        if (*member.offset < end)
          throw Error(fmt::format("OFFSET {} of {} in the struct {} lies in the member before it, which ends at {}",
                                  *member.offset, member.name, declared.name, end));
        offset = *member.offset;
      }
      end = offset + laid_out.type.size;
      narrow(end, declared.name);
      result.alignment = std::max(result.alignment, laid_out.alignment);
      result.type.members.push_back({member.name, offset, laid_out.type});
    }
    result.type.size = round_up(end, result.alignment);
    if (declared.stride) {
      if (*declared.stride < end)
        throw Error(fmt::format("STRIDE {} of the struct {} is smaller than its {} bytes", *declared.stride,
                                declared.name, end));
      result.type.size = *declared.stride;
    }
    return result;
  }

  Layout layout_;
};

}  // namespace

std::optional<DataType> parse_data_type(std::string_view word) {
  const std::size_t bracket = word.find('[');
  if (bracket == std::string_view::npos) return parse_element(word);
  if (!word.ends_with(']')) return std::nullopt;
  std::optional<DataType> type = parse_element(word.substr(0, bracket));
  if (!type) return std::nullopt;
  const std::string_view digits = word.substr(bracket + 1, word.size() - bracket - 2);
  type->is_array = true;
  if (digits.empty()) return type;
  std::uint32_t count = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), count);
  if (error != std::errc() || end != digits.data() + digits.size() || count == 0) return std::nullopt;
  type->count = count;
  return type;
}

LaidOut lay_out(const DataType& type, Layout layout) {
  const Rules rules(layout);
  Aligned laid_out = rules.apply(type, nullptr);
  if (type.is_array && type.count == 0) {
    const ValueType array = std::move(laid_out.type);
    return {array.element.front(), array.stride};
  }
  narrow(laid_out.type.size, describe(laid_out.type));
  if (scalar_count(laid_out.type, laid_out.type.size) > most_scalars)
    throw Error(fmt::format("the type {} has more than {} values", describe(laid_out.type), most_scalars));
  // The items of a buffer whose type is no array are padded to their own alignment alone, in every layout.
  const std::uint64_t stride =
      type.structure && type.structure->stride ? laid_out.type.size : round_up(laid_out.type.size, laid_out.alignment);
  return {std::move(laid_out.type), narrow(stride, "of the items")};
}

}  // namespace tandem::program::amber
