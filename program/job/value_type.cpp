#include "program/job/value_type.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>

namespace tandem::program {
namespace {

using Kind = ValueType::Kind;

struct ScalarInfo {
  std::string_view name;
  std::uint32_t size;
  std::string_view glsl;         ///< of a scalar
  std::string_view glsl_prefix;  ///< of a vector
};

constexpr std::array<ScalarInfo, 11> scalar_infos = {{{"int8", 1, "int8_t", "i8"},
                                                      {"uint8", 1, "uint8_t", "u8"},
                                                      {"float16", 2, "float16_t", "f16"},
                                                      {"int16", 2, "int16_t", "i16"},
                                                      {"uint16", 2, "uint16_t", "u16"},
                                                      {"float32", 4, "float", ""},
                                                      {"int32", 4, "int", "i"},
                                                      {"uint32", 4, "uint", "u"},
                                                      {"float64", 8, "double", "d"},
                                                      {"int64", 8, "int64_t", "i64"},
                                                      {"uint64", 8, "uint64_t", "u64"}}};

const ScalarInfo& info_of(ScalarType scalar) { return scalar_infos[static_cast<std::size_t>(scalar)]; }

/// Bytes that are left for a member or an element at `offset`.
std::uint64_t left_of(std::uint64_t bytes, std::uint64_t offset) { return bytes - std::min(bytes, offset); }

std::uint64_t element_count(const ValueType& array, std::uint64_t bytes) {
  return array.count != 0 ? array.count : array.stride != 0 ? bytes / array.stride : 0;
}

std::string component_name(const ValueType& vector, std::uint64_t index) {
  return vector.rows <= 4 ? std::string(".") + "xyzw"[index] : fmt::format("[{}]", index);
}

/// The scalar number `index` of a value at `offset`, and what it is called, which is appended to `path` if it is given.
Place find_scalar(const ValueType& type, std::uint64_t offset, std::uint64_t bytes, std::uint64_t index,
                  std::string* path) {
  switch (type.kind) {
    case Kind::scalar:
      break;
    case Kind::vector:
      if (path != nullptr) *path += component_name(type, index);
      offset += index * size_of(type.scalar);
      break;
    case Kind::matrix: {
      const std::uint64_t column = index / type.rows, row = index % type.rows;
      if (path != nullptr) *path += fmt::format("[{}][{}]", column, row);
      const std::uint64_t lines = type.row_major ? row : column, within = type.row_major ? column : row;
      offset += lines * type.stride + within * size_of(type.scalar);
      break;
    }
    case Kind::array: {
      const ValueType& element = type.element.front();
      const std::uint64_t scalars = scalar_count(element, element.size);
      const std::uint64_t number = index / scalars;
      if (path != nullptr) *path += fmt::format("[{}]", number);
      return find_scalar(element, offset + number * type.stride, element.size, index % scalars, path);
    }
    case Kind::structure:
      for (const Member& member : type.members) {
        const std::uint64_t left = left_of(bytes, member.offset), scalars = scalar_count(member.type, left);
        if (index >= scalars) {
          index -= scalars;
          continue;
        }
        if (path != nullptr) *path += (path->empty() ? "" : ".") + member.name;
        return find_scalar(member.type, offset + member.offset, left, index, path);
      }
      break;
  }
  return {.offset = offset, .scalar = type.scalar};
}

}  // namespace

std::uint32_t size_of(ScalarType scalar) { return info_of(scalar).size; }

std::string_view name_of(ScalarType scalar) { return info_of(scalar).name; }

bool is_floating(ScalarType scalar) {
  return scalar == ScalarType::float16 || scalar == ScalarType::float32 || scalar == ScalarType::float64;
}

bool is_signed(ScalarType scalar) { return is_floating(scalar) || name_of(scalar).front() == 'i'; }

ValueType make_type(ScalarType scalar, std::uint32_t rows) {
  return {.kind = rows == 1 ? Kind::scalar : Kind::vector,
          .scalar = scalar,
          .rows = rows,
          .size = std::uint64_t{rows} * size_of(scalar)};
}

ValueType make_array(ValueType element, std::uint64_t count, std::uint32_t stride) {
  ValueType array{
      .kind = Kind::array, .stride = stride != 0 ? stride : static_cast<std::uint32_t>(element.size), .count = count};
  array.size = count * array.stride;
  array.element.push_back(std::move(element));
  return array;
}

std::string describe(const ValueType& type) {
  const ScalarInfo& scalar = info_of(type.scalar);
  switch (type.kind) {
    case Kind::scalar:
      return std::string(scalar.glsl);
    case Kind::vector:
      return fmt::format("{}vec{}", scalar.glsl_prefix, type.rows);
    case Kind::matrix:
      return type.rows == type.columns ? fmt::format("{}mat{}", scalar.glsl_prefix, type.columns)
                                       : fmt::format("{}mat{}x{}", scalar.glsl_prefix, type.columns, type.rows);
    case Kind::array: {
      std::string lengths;
      const ValueType* inner = &type;
      for (; inner->kind == Kind::array; inner = &inner->element.front())
        lengths += inner->count != 0 ? fmt::format("[{}]", inner->count) : "[]";
      return describe(*inner) + lengths;
    }
    case Kind::structure:
      break;
  }
  return type.name.empty() ? "struct" : type.name;
}

std::uint64_t scalar_count(const ValueType& type, std::uint64_t bytes) {
  switch (type.kind) {
    case Kind::scalar:
      return 1;
    case Kind::vector:
      return type.rows;
    case Kind::matrix:
      return std::uint64_t{type.columns} * type.rows;
    case Kind::array: {
      const ValueType& element = type.element.front();
      return element_count(type, bytes) * scalar_count(element, element.size);
    }
    case Kind::structure:
      break;
  }
  std::uint64_t count = 0;
  for (const Member& member : type.members) count += scalar_count(member.type, left_of(bytes, member.offset));
  return count;
}

Place place_of(const ValueType& type, std::uint64_t bytes, std::uint64_t index) {
  return find_scalar(type, 0, bytes, index, nullptr);
}

std::string path_of(const ValueType& type, std::uint64_t bytes, std::uint64_t index) {
  std::string path;
  find_scalar(type, 0, bytes, index, &path);
  return path;
}

void for_each_place(const ValueType& type, std::uint64_t bytes, const std::function<void(const Place&)>& visit,
                    std::uint64_t offset) {
  if (type.kind == Kind::array) {
    const ValueType& element = type.element.front();
    const std::uint64_t count = element_count(type, bytes);
    for (std::uint64_t i = 0; i < count; ++i) for_each_place(element, element.size, visit, offset + i * type.stride);
  } else if (type.kind == Kind::structure) {
    for (const Member& member : type.members)
      for_each_place(member.type, left_of(bytes, member.offset), visit, offset + member.offset);
  } else {
    const std::uint64_t count = scalar_count(type, bytes);
    for (std::uint64_t i = 0; i < count; ++i) visit(find_scalar(type, offset, bytes, i, nullptr));
  }
}

}  // namespace tandem::program
