#include "program/data/npy.hpp"

#include <algorithm>
#include <charconv>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/input_file.hpp"
#include "base/printable.hpp"
#include "program/data/scalar.hpp"

namespace tandem::program {
namespace {

constexpr std::string_view magic = "\x93NUMPY";
constexpr std::size_t alignment = 64;                         // of the data in the file
constexpr std::uint64_t most_bytes = std::uint64_t{1} << 32;  // of a file

/// "<f4" and so on; the sign of the byte order apart.
std::string code_of(ScalarType scalar) {
  const char kind = is_floating(scalar) ? 'f' : is_signed(scalar) ? 'i' : 'u';
  return fmt::format("{}{}", kind, size_of(scalar));
}

std::optional<ScalarType> scalar_of(std::string_view code) {
  if (code == "b1") return ScalarType::uint8;  // Python's bool
  for (int i = 0; i <= static_cast<int>(ScalarType::uint64); ++i)
    if (code_of(static_cast<ScalarType>(i)) == code) return static_cast<ScalarType>(i);
  return std::nullopt;
}

/// What stands behind a key of the header, up to the end that its first character has: '...' or (...), or a comma.
std::string_view value_of(std::string_view header, std::string_view key) {
  const std::size_t found = header.find(fmt::format("'{}':", key));
  if (found == std::string_view::npos) return {};
  std::string_view rest = header.substr(found + key.size() + 3);
  rest.remove_prefix(std::min(rest.find_first_not_of(' '), rest.size()));
  if (rest.empty()) return {};
  const char end = rest[0] == '\'' ? '\'' : rest[0] == '(' ? ')' : rest[0] == '[' ? ']' : ',';
  const std::size_t begin = end == ',' ? 0 : 1;
  return rest.substr(begin, rest.find(end, begin) - begin);
}

void append_shape(const ValueType& type, std::uint64_t bytes, std::vector<std::uint64_t>& shape) {
  switch (type.kind) {
    case ValueType::Kind::array: {
      const ValueType& element = type.element.front();
      const std::uint64_t each = std::max<std::uint64_t>(scalar_count(element, element.size), 1);
      shape.push_back(scalar_count(type, bytes) / each);
      append_shape(element, element.size, shape);
      break;
    }
    case ValueType::Kind::matrix:
      shape.push_back(type.columns);
      shape.push_back(type.rows);
      break;
    case ValueType::Kind::vector:
      shape.push_back(type.rows);
      break;
    case ValueType::Kind::structure:
      shape.push_back(scalar_count(type, bytes));
      break;
    case ValueType::Kind::scalar:
      break;
  }
}

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& why) {
  throw Error(fmt::format("cannot read '{}': {}", shortened(path.string()), why));
}

}  // namespace

NpyArray read_npy(const std::filesystem::path& path) {
  const std::string file = read_bytes(path, most_bytes);
  if (!file.starts_with(magic) || file.size() < 12) refuse(path, "it is no .npy file");
  const bool is_short = file[6] == 1;
  std::uint32_t length = 0;
  std::memcpy(&length, file.data() + 8, is_short ? 2 : 4);
  const std::size_t begin = is_short ? 10 : 12;
  if (length > file.size() - begin) refuse(path, "it ends within its header");
  const std::string_view header = std::string_view(file).substr(begin, length);
  const std::string_view data = std::string_view(file).substr(begin + length);

  NpyArray array;
  const std::string_view descr = value_of(header, "descr");
  if (descr.starts_with('>')) refuse(path, "it is big-endian");
  const std::optional<ScalarType> scalar = descr.empty() ? std::nullopt : scalar_of(descr.substr(1));
  if (!scalar) refuse(path, fmt::format("no shader has values of the type '{}'", shortened(descr)));
  array.scalar = *scalar;
  std::uint64_t count = 1;
  for (std::string_view shape = value_of(header, "shape"); !shape.empty();) {
    std::uint64_t side = 0;
    const auto [end, error] = std::from_chars(shape.data(), shape.data() + shape.size(), side);
    if (error != std::errc{} || (side != 0 && count > most_bytes / side)) refuse(path, "its shape is no shape");
    array.shape.push_back(side);
    count *= side;
    shape.remove_prefix(static_cast<std::size_t>(end - shape.data()));
    shape.remove_prefix(std::min(shape.find_first_not_of(", "), shape.size()));
  }
  if (value_of(header, "fortran_order") == "True" && array.shape.size() > 1)
    refuse(path, "it is in Fortran's order; numpy.ascontiguousarray turns it around");
  if (data.size() < count * size_of(array.scalar)) refuse(path, "it ends before its last number");
  const auto bytes = std::as_bytes(std::span(data)).first(static_cast<std::size_t>(count * size_of(array.scalar)));
  array.bytes.assign(bytes.begin(), bytes.end());
  return array;
}

std::vector<std::byte> to_npy(const NpyArray& array) {
  std::string shape;
  for (const std::uint64_t side : array.shape) shape += fmt::format("{}, ", side);
  if (array.shape.size() > 1) shape.resize(shape.size() - 2);
  if (array.shape.size() == 1) shape.pop_back();
  std::string header = fmt::format("{{'descr': '{}{}', 'fortran_order': False, 'shape': ({}), }}",
                                   size_of(array.scalar) == 1 ? '|' : '<', code_of(array.scalar), shape);
  const std::size_t unpadded = magic.size() + 4 + header.size() + 1;
  header += std::string((alignment - unpadded % alignment) % alignment, ' ') + "\n";
  std::string file = std::string(magic) + '\1' + '\0' + static_cast<char>(header.size() & 0xff) +
                     static_cast<char>(header.size() >> 8) + header;
  const auto start = std::as_bytes(std::span(file));
  std::vector<std::byte> bytes(start.begin(), start.end());
  bytes.insert(bytes.end(), array.bytes.begin(), array.bytes.end());
  return bytes;
}

NpyArray npy_of(const ValueType& type, std::span<const std::byte> bytes) {
  NpyArray array;
  append_shape(type, bytes.size(), array.shape);
  bool is_first = true;
  for_each_place(type, bytes.size(), [&](const Place& place) {
    if (is_first) array.scalar = place.scalar;
    is_first = false;
    if (place.scalar != array.scalar)
      throw Error(fmt::format("{} holds values of several types, which an array of NumPy does not", describe(type)));
    const auto scalar = bytes.subspan(static_cast<std::size_t>(place.offset), size_of(place.scalar));
    array.bytes.insert(array.bytes.end(), scalar.begin(), scalar.end());
  });
  // The members of a structure may have shapes of their own.
  std::uint64_t count = 1;
  for (const std::uint64_t side : array.shape) count *= side;
  if (const std::uint64_t scalars = array.bytes.size() / size_of(array.scalar); count != scalars)
    array.shape = {scalars};
  return array;
}

void fill_from(std::span<std::byte> bytes, const ValueType& type, const NpyArray& array) {
  const std::uint64_t count = array.bytes.size() / size_of(array.scalar);
  const std::uint64_t places = scalar_count(type, bytes.size());
  if (count > places) throw Error(fmt::format("{} values are given, where {} holds {}", count, describe(type), places));
  std::uint64_t index = 0;
  for_each_place(type, bytes.size(), [&](const Place& place) {
    if (index >= count) return;
    if (place.scalar != array.scalar)
      throw Error(
          fmt::format("the array holds {}, where the shader has {}", name_of(array.scalar), name_of(place.scalar)));
    const Place source{.offset = index++ * size_of(array.scalar), .scalar = array.scalar};
    set_bits(bytes, place, bits_at(array.bytes, source));
  });
}

}  // namespace tandem::program
