#include "program/explain/value_text.hpp"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstdint>

namespace tandem::program {
namespace {

constexpr std::size_t most_scalars = 16;

std::uint64_t bits_of(const RecordedWords& value, const Component& component) {
  std::uint64_t bits = value.words[component.word];
  if (component.width == 64) bits |= std::uint64_t{value.words[component.word + 1]} << 32;
  return bits;
}

std::string scalar_text(const RecordedWords& value, const Component& component) {
  const std::uint64_t bits = bits_of(value, component);
  switch (component.kind) {
    case ComponentKind::boolean:
      return bits != 0 ? "true" : "false";
    case ComponentKind::unsigned_integer:
      return fmt::format("{}", bits);
    case ComponentKind::signed_integer: {
      const unsigned shift = 64 - component.width;
      return fmt::format("{}", static_cast<std::int64_t>(bits << shift) >> shift);
    }
    case ComponentKind::floating:
      break;
  }
  if (component.width == 64) return fmt::format("{}", std::bit_cast<double>(bits));
  return fmt::format("{}", std::bit_cast<float>(static_cast<std::uint32_t>(bits)));
}

/// The floats in their order, as integers; both zeros are 0.
std::int64_t ordered(std::uint64_t bits, std::uint32_t width) {
  const std::uint64_t sign = std::uint64_t{1} << (width - 1);
  return (bits & sign) != 0 ? -static_cast<std::int64_t>(bits & (sign - 1)) : static_cast<std::int64_t>(bits);
}

/// The bits of a float of 16 bits that is recorded as one of 32.
std::uint32_t narrowed(std::uint32_t bits) {
  const float value = std::bit_cast<float>(bits);
  const std::uint32_t sign = bits >> 31 << 15;
  if (std::isinf(value)) return sign | 0x7c00;
  const float magnitude = std::fabs(value);
  // Every value of 16 bits is exact here: a subnormal one counts units of 2^-24.
  if (magnitude < 0x1p-14f) return sign | static_cast<std::uint32_t>(magnitude * 0x1p24f);
  return sign | (((bits & 0x7fffffff) >> 13) - (112u << 10));
}

}  // namespace

std::string value_text(const RecordedWords& value) {
  if (value.components.size() == 1) return scalar_text(value, value.components[0]);
  std::string text = "(";
  for (std::size_t i = 0; i < value.components.size(); ++i) {
    if (i == most_scalars) return text + ", ...)";
    text += (i == 0 ? "" : ", ") + scalar_text(value, value.components[i]);
  }
  return text + ")";
}

std::string bits_text(const RecordedWords& value, std::size_t index) {
  const Component& component = value.components[index];
  const std::uint64_t bits = bits_of(value, component);
  if (component.kind == ComponentKind::floating && component.width == 16)
    return fmt::format("0x{:04x}", narrowed(static_cast<std::uint32_t>(bits)));
  return fmt::format("0x{:0{}x}", bits, component.width / 4);
}

std::size_t first_other_component(const RecordedWords& a, const RecordedWords& b) {
  for (std::size_t i = 0; i < a.components.size(); ++i)
    if (bits_of(a, a.components[i]) != bits_of(b, b.components[i])) return i;
  return 0;
}

std::optional<std::uint64_t> ulp_distance(const RecordedWords& a, const RecordedWords& b, std::size_t index) {
  const Component& component = a.components[index];
  if (component.kind != ComponentKind::floating) return std::nullopt;
  std::uint64_t x = bits_of(a, component), y = bits_of(b, component);
  if (component.width == 64 ? std::isnan(std::bit_cast<double>(x)) || std::isnan(std::bit_cast<double>(y))
                            : std::isnan(std::bit_cast<float>(static_cast<std::uint32_t>(x))) ||
                                  std::isnan(std::bit_cast<float>(static_cast<std::uint32_t>(y))))
    return std::nullopt;
  if (component.width == 16) {
    x = narrowed(static_cast<std::uint32_t>(x));
    y = narrowed(static_cast<std::uint32_t>(y));
  }
  const std::int64_t difference = ordered(x, component.width) - ordered(y, component.width);
  return static_cast<std::uint64_t>(difference < 0 ? -difference : difference);
}

}  // namespace tandem::program
