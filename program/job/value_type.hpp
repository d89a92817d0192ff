#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

/// How values lie in memory: what the members of a shader's block, the elements of a buffer and the texels of an image
/// are. All sizes, offsets and strides are in bytes.
namespace tandem::program {

enum class ScalarType : std::uint8_t {
  int8,
  uint8,
  float16,
  int16,
  uint16,
  float32,
  int32,
  uint32,
  float64,
  int64,
  uint64
};

std::uint32_t size_of(ScalarType scalar);
/// "int8", "uint8", "float16" and so on.
std::string_view name_of(ScalarType scalar);
bool is_floating(ScalarType scalar);
bool is_signed(ScalarType scalar);  ///< floats are

/// A member of a structure. A template, so that it may be named where ValueType is not yet complete.
template <typename Type>
struct BasicMember {
  std::string name;
  std::uint64_t offset = 0;
  Type type;
};

struct ValueType;
using Member = BasicMember<ValueType>;

/// A type with its layout.
struct ValueType {
  enum class Kind : std::uint8_t { scalar, vector, matrix, array, structure };

  Kind kind = Kind::scalar;
  ScalarType scalar = ScalarType::uint32;  ///< of scalars, vectors and matrices
  std::uint32_t rows = 1;                  ///< components of a vector, or of a column of a matrix
  std::uint32_t columns = 1;               ///< of a matrix
  bool row_major = false;                  ///< of a matrix: `stride` lies between rows
  std::uint32_t stride = 0;                ///< between the elements of an array, or the columns of a matrix
  std::uint64_t count = 0;                 ///< elements of an array; 0: as many as the buffer holds
  std::uint64_t size = 4;               ///< 0 for an array without a length; a structure's without such a last member
  std::vector<ValueType> element = {};  ///< of an array: exactly one
  std::vector<Member> members = {};     ///< of a structure, in their order
  std::string name = {};                ///< of a structure, "" for any other
};

/// A scalar, or with `rows` a vector, tightly packed.
ValueType make_type(ScalarType scalar, std::uint32_t rows = 1);
/// `count` elements, `stride` bytes apart; 0: the element's size.
ValueType make_array(ValueType element, std::uint64_t count, std::uint32_t stride = 0);

/// One scalar of a value.
struct Place {
  std::uint64_t offset = 0;
  ScalarType scalar = ScalarType::uint32;
};

/// The type in GLSL's words: "vec3", "float[4]", "mat3x4", or the structure's name.
std::string describe(const ValueType& type);

/// How many scalars `bytes` bytes of the type hold, whole elements of unsized arrays counted.
/// @pre bytes >= type.size
std::uint64_t scalar_count(const ValueType& type, std::uint64_t bytes);

/// The scalar number `index`, in the order of declaration, elements and components. @pre index < scalar_count()
Place place_of(const ValueType& type, std::uint64_t bytes, std::uint64_t index);

/// What the scalar number `index` is called from the value on: "position[3].y", "[7]", "matrix[2][1]"; "" for a scalar.
std::string path_of(const ValueType& type, std::uint64_t bytes, std::uint64_t index);

/// All scalars in the order of their numbers, in time proportional to their count.
/// @param offset of the value, added to the places'
void for_each_place(const ValueType& type, std::uint64_t bytes, const std::function<void(const Place&)>& visit,
                    std::uint64_t offset = 0);

}  // namespace tandem::program
