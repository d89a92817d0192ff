#include "program/data/fill.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/printable.hpp"
#include "program/data/scalar.hpp"

namespace tandem::program {
namespace {

/// SplitMix64 (Steele, Lea, Flood: Fast Splittable Pseudorandom Number Generators, 2014).
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  /// In [0, 1), a multiple of 2^-53.
  double next() {
    std::uint64_t z = state_ += 0x9e3779b97f4a7c15;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
    z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
    return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
  }

 private:
  std::uint64_t state_;
};

constexpr std::uint64_t most_names = 20;  // in a sentence

/// Whether a scalar lies in the part of that name, or is it.
bool is_part(std::string_view path, std::string_view part) {
  if (!path.starts_with(part)) return false;
  return path.size() == part.size() || path[part.size()] == '.' || path[part.size()] == '[';
}

void set_text(std::span<std::byte> bytes, const ValueType& type, const Place& place, std::uint64_t index,
              const std::string& text) {
  try {
    set_bits(bytes, place, from_text(place.scalar, text));
  } catch (const Error& error) {
    const std::string path = path_of(type, bytes.size(), index);
    throw Error(path.empty() ? error.what() : fmt::format("{}: {}", path, error.what()));
  }
}

}  // namespace

const ValueType* unsized_array(const ValueType& type) {
  if (type.kind == ValueType::Kind::array) return type.count == 0 ? &type : nullptr;
  if (type.kind == ValueType::Kind::structure && !type.members.empty()) return unsized_array(type.members.back().type);
  return nullptr;
}

std::uint64_t size_with(const ValueType& type, std::uint64_t elements) {
  std::uint64_t size = type.size;
  if (const ValueType* array = unsized_array(type)) {
    const std::uint64_t offset = type.kind == ValueType::Kind::structure ? type.members.back().offset : 0;
    size = std::max(size, offset + elements * array->stride);
  }
  return std::max<std::uint64_t>(size, 1);
}

std::uint64_t elements_for(const ValueType& type, std::uint64_t scalars) {
  const ValueType* array = unsized_array(type);
  if (array == nullptr) return 0;
  const ValueType& element = array->element.front();
  const std::uint64_t fixed = scalar_count(type, type.size);
  const std::uint64_t each = std::max<std::uint64_t>(scalar_count(element, element.size), 1);
  return scalars > fixed ? (scalars - fixed + each - 1) / each : 0;
}

void fill_iota(std::span<std::byte> bytes, const ValueType& type) {
  std::uint64_t number = 0;
  for_each_place(type, bytes.size(),
                 [&](const Place& place) { set_bits(bytes, place, bits_of_whole(place.scalar, number++)); });
}

void fill_random(std::span<std::byte> bytes, const ValueType& type, std::uint64_t seed, double minimum,
                 double maximum) {
  Random random(seed);
  for_each_place(type, bytes.size(), [&](const Place& place) {
    // One more, so that the largest whole number is as frequent as the others.
    const double end = is_floating(place.scalar) ? maximum : maximum + 1;
    const double number = minimum + random.next() * (end - minimum);
    set_bits(bytes, place, bits_of_number(place.scalar, is_floating(place.scalar) ? number : std::floor(number)));
  });
}

void fill_values(std::span<std::byte> bytes, const ValueType& type, std::span<const std::string> texts) {
  const std::uint64_t count = scalar_count(type, bytes.size());
  if (texts.size() > count)
    throw Error(fmt::format("{} values are given, where {} holds {}", texts.size(), describe(type), count));
  std::size_t index = 0;
  for_each_place(type, bytes.size(), [&](const Place& place) {
    if (index < texts.size()) set_text(bytes, type, place, index, texts[index]);
    ++index;
  });
}

void fill_part(std::span<std::byte> bytes, const ValueType& type, std::string_view part,
               std::span<const std::string> texts) {
  const std::uint64_t count = scalar_count(type, bytes.size());
  std::string known;
  std::size_t used = 0, found = 0;
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::string path = path_of(type, bytes.size(), i);
    if (i < most_names) known += (i == 0 ? "" : ", ") + path;
    if (!is_part(path, part)) continue;
    ++found;
    if (used < texts.size()) set_text(bytes, type, place_of(type, bytes.size(), i), i, texts[used++]);
  }
  if (found == 0)
    throw Error(fmt::format("'{}' is not the name of a value; the names are {}{}", shortened(part), known,
                            count > most_names ? ", ..." : ""));
  if (texts.size() > found)
    throw Error(fmt::format("{} values are given, where {} holds {}", texts.size(), part, found));
}

}  // namespace tandem::program
