#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "program/amber/value/texel.hpp"
#include "program/job/value_type.hpp"

/// The types of a script's buffers and images, and how they lie in memory.
namespace tandem::program::amber {

struct Struct;

/// A type by its name, before a layout gives it offsets and strides.
struct DataType {
  ScalarType scalar = ScalarType::uint32;
  std::uint32_t rows = 1;
  std::uint32_t columns = 1;  ///< more than 1: a matrix
  bool is_array = false;      ///< "float[4]", or "float[]", whose elements lie as those of an array do
  std::uint64_t count = 0;    ///< of an array; 0 for "[]"
  std::shared_ptr<const Struct> structure = {};  ///< null for all other types
  std::optional<Texel> texel = {};               ///< of a type that is a format
};

struct StructMember {
  std::string name;
  DataType type;
  std::optional<std::uint32_t> offset = {};
  std::optional<std::uint32_t> array_stride = {};
  std::optional<std::uint32_t> matrix_stride = {};
};

struct Struct {
  std::string name;
  std::optional<std::uint32_t> stride = {};
  std::vector<StructMember> members;
};

/// "int8", "vec3<float>", "mat2x4<double>", "R8G8_UINT", each also with "[]" or "[N]"; empty for any other word.
std::optional<DataType> parse_data_type(std::string_view word);

/// The rules of GLSL. scalar (GL_EXT_scalar_block_layout) is ours: Amber's language has std140 and std430.
enum class Layout : std::uint8_t { std140, std430, scalar };

/// A type with its layout, and the bytes from one of them to the next in a buffer.
struct LaidOut {
  ValueType type;
  std::uint32_t stride = 4;
};

/// Throws Error, in words that name the struct, where its offsets or strides are too small, or it has more than 2 GiB.
LaidOut lay_out(const DataType& type, Layout layout);

}  // namespace tandem::program::amber
