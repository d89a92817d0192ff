#include "program/amber/expectation.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "program/amber/value/values.hpp"

namespace tandem::program::amber {
namespace {

constexpr double equal_percent = 1e-6;
constexpr double texel_tolerance = 0.002;

bool is_near(double actual, double expected, const Tolerance& tolerance) {
  if (std::isnan(actual) || std::isnan(expected)) return std::isnan(actual) == std::isnan(expected);
  if (actual == expected) return true;  // also two infinities, whose difference is none
  const double allowed = tolerance.percent ? tolerance.value / 100 * std::fabs(expected) : tolerance.value;
  return std::fabs(actual - expected) <= allowed;
}

std::string_view sign_of(Comparison comparison) {
  switch (comparison) {
    case Comparison::equal:
      return "";
    case Comparison::not_equal:
      return "not ";
    case Comparison::less:
      return "less than ";
    case Comparison::less_or_equal:
      return "at most ";
    case Comparison::greater:
      return "greater than ";
    case Comparison::greater_or_equal:
      return "at least ";
  }
  return "";
}

std::string text_of(const Tolerance& tolerance) {
  return fmt::format(" within {}{}", tolerance.value, tolerance.percent ? " %" : "");
}

template <typename T>
bool holds(Comparison comparison, T actual, T expected) {
  switch (comparison) {
    case Comparison::equal:
      return actual == expected;
    case Comparison::not_equal:
      return actual != expected;
    case Comparison::less:
      return actual < expected;
    case Comparison::less_or_equal:
      return actual <= expected;
    case Comparison::greater:
      return actual > expected;
    case Comparison::greater_or_equal:
      return actual >= expected;
  }
  return false;
}

bool holds(Comparison comparison, const Number& actual, const Number& expected, ScalarType scalar,
           const std::optional<Tolerance>& tolerance) {
  if (tolerance) return is_near(actual.value, expected.value, *tolerance);
  if (!is_floating(scalar))
    return is_signed(scalar)
               ? holds(comparison, static_cast<std::int64_t>(actual.bits), static_cast<std::int64_t>(expected.bits))
               : holds(comparison, actual.bits, expected.bits);
  const bool near = is_near(actual.value, expected.value, {equal_percent, true});
  if (comparison == Comparison::equal) return near;
  if (comparison == Comparison::not_equal) return !near;
  return holds(comparison, actual.value, expected.value);
}

/// The tolerance of a component. @param otherwise of the components after those that a list names
template <typename T>
T tolerance_of(const std::vector<Tolerance>& tolerances, std::size_t component, const T& otherwise) {
  if (tolerances.empty()) return otherwise;
  if (tolerances.size() == 1) return tolerances.front();
  return component < tolerances.size() ? T(tolerances[component]) : otherwise;
}

std::string failure_of(const ValuesExpectation& expected, std::span<const std::byte> contents,
                       const std::string& name) {
  const Values values(expected.element, expected.stride);
  for (std::size_t i = 0; i < expected.values.size(); ++i) {
    const Place place = values.place(i);
    const std::uint64_t offset = expected.offset + place.offset;
    if (offset > contents.size() || size_of(place.scalar) > contents.size() - offset)
      return fmt::format("{} has {} bytes, and value {} of the expectation lies at {}", name, contents.size(), i,
                         offset);
    const Number actual = read(contents.subspan(offset), place.scalar);
    // As the memory would hold it.
    std::array<std::byte, 8> bytes = {};
    write(bytes, place.scalar, expected.values[i]);
    const Number wanted = read(bytes, place.scalar);
    const std::size_t component = i % values.scalars_per_element();
    const std::optional<Tolerance> tolerance =
        tolerance_of(expected.tolerances, component,
                     std::optional<Tolerance>(
                         expected.tolerances.empty() ? std::nullopt : std::optional(Tolerance{equal_percent, true})));
    if (!holds(expected.comparison, actual, wanted, place.scalar, tolerance))
      return fmt::format("{} is {} at byte {}, expected {}{}{}", name, text_of(actual, place.scalar), offset,
                         sign_of(expected.comparison), text_of(wanted, place.scalar),
                         tolerance ? text_of(*tolerance) : "");
  }
  return "";
}

bool is_normalized(const Texel& texel) {
  const Encoding encoding = texel.components.front().encoding;
  return encoding != Encoding::uint && encoding != Encoding::sint && encoding != Encoding::uscaled &&
         encoding != Encoding::sscaled;
}

std::string failure_of(const TexelsExpectation& expected, std::span<const std::byte> contents,
                       const std::string& name) {
  constexpr std::string_view names = "RGBA";
  const double scale = is_normalized(expected.texel) ? 255 : 1;
  std::uint64_t wrong = 0;
  std::string first;
  for (std::uint32_t y = 0; y < expected.count[1]; ++y)
    for (std::uint32_t x = 0; x < expected.count[0]; ++x) {
      const std::uint64_t index = (std::uint64_t{expected.first[1]} + y) * expected.size[0] + expected.first[0] + x;
      const std::uint64_t offset = index * expected.texel.size;
      if (offset + expected.texel.size > contents.size())
        return fmt::format("{} has {} bytes, and texel ({}, {}) lies at {}", name, contents.size(),
                           expected.first[0] + x, expected.first[1] + y, offset);
      bool good = true;
      std::vector<double> actual;
      for (const Component& component : expected.texel.components) {
        const std::size_t channel = names.find(component.name);
        if (channel == std::string_view::npos || (channel == 3 && !expected.alpha)) continue;
        actual.push_back(value_of(component, contents.subspan(offset, expected.texel.size)));
        const Tolerance tolerance = tolerance_of(expected.tolerances, channel, Tolerance{texel_tolerance, false});
        good = good && is_near(actual.back(), expected.color[channel] / scale, tolerance);
        actual.back() *= scale;
      }
      if (good) continue;
      if (wrong++ == 0)
        first = fmt::format("{} is {:g} at ({}, {}), expected {}", name, fmt::join(actual, " "), expected.first[0] + x,
                            expected.first[1] + y,
                            fmt::join(expected.color.begin(), expected.color.end() - (expected.alpha ? 0 : 1), " "));
    }
  if (wrong < 2) return first;
  return fmt::format("{}, and {} further texels are wrong", first, wrong - 1);
}

std::string different_bytes(std::span<const std::byte> contents, std::span<const std::byte> other,
                            const BuffersExpectation& expected, const std::string& name) {
  if (std::equal(contents.begin(), contents.end(), other.begin(), other.end())) return "";
  const auto first = std::mismatch(contents.begin(), contents.end(), other.begin()).first - contents.begin();
  const Values values(expected.element, expected.stride);
  const std::uint64_t count = values.count(contents.size());
  for (std::uint64_t i = 0; i < count; ++i) {
    const Place place = values.place(i);
    const auto offset = static_cast<std::uint64_t>(first);
    if (offset < place.offset || offset >= place.offset + size_of(place.scalar)) continue;
    return fmt::format("{} is {} at byte {}, where {} is {}", name,
                       text_of(read(contents.subspan(place.offset), place.scalar), place.scalar), place.offset,
                       expected.other_name, text_of(read(other.subspan(place.offset), place.scalar), place.scalar));
  }
  return fmt::format("{} and {} differ at byte {}, between two values", name, expected.other_name, first);
}

double root_mean_square(std::span<const std::byte> contents, std::span<const std::byte> other, const Values& values) {
  const std::uint64_t count = values.count(contents.size());
  double sum = 0;
  for (std::uint64_t i = 0; i < count; ++i) {
    const Place place = values.place(i);
    const double difference = read(contents.subspan(place.offset), place.scalar).value -
                              read(other.subspan(place.offset), place.scalar).value;
    sum += difference * difference;
  }
  return count == 0 ? 0 : std::sqrt(sum / static_cast<double>(count));
}

/// Moves one histogram into the other: the sum of how much has to pass from each bin to the next, in units of a
/// histogram that is moved through all of them.
double earth_movers(std::span<const std::byte> contents, std::span<const std::byte> other, std::size_t channel) {
  std::array<double, 256> difference = {};
  const std::size_t texels = contents.size() / 4;
  for (std::size_t i = 0; i < texels; ++i) {
    difference[std::to_integer<std::size_t>(contents[4 * i + channel])] += 1;
    difference[std::to_integer<std::size_t>(other[4 * i + channel])] -= 1;
  }
  double carried = 0;
  double distance = 0;
  for (const double each : difference) {
    carried += each / static_cast<double>(texels);
    distance += std::fabs(carried);
  }
  return distance / static_cast<double>(difference.size());
}

std::string failure_of(const BuffersExpectation& expected, std::span<const std::byte> contents,
                       std::span<const std::byte> other, const std::string& name) {
  if (contents.size() != other.size())
    return fmt::format("{} has {} bytes, {} has {}", name, contents.size(), expected.other_name, other.size());
  if (expected.measure == BuffersExpectation::Measure::equal) return different_bytes(contents, other, expected, name);
  double distance = 0;
  std::string_view what = "root mean square error";
  if (expected.measure == BuffersExpectation::Measure::root_mean_square) {
    distance = root_mean_square(contents, other, Values(expected.element, expected.stride));
  } else {
    what = "earth mover's distance of the histograms";
    for (std::size_t channel = 0; channel < 4; ++channel)
      distance = std::max(distance, earth_movers(contents, other, channel));
  }
  if (distance <= expected.tolerance) return "";  // a NaN is no success
  return fmt::format("the {} of {} and {} is {:.6g}, expected at most {:g}", what, name, expected.other_name, distance,
                     expected.tolerance);
}

}  // namespace

std::string failure(const Expectation& expectation, std::span<const std::byte> contents,
                    std::span<const std::byte> other) {
  if (const auto* values = std::get_if<ValuesExpectation>(&expectation.what))
    return failure_of(*values, contents, expectation.name);
  if (const auto* texels = std::get_if<TexelsExpectation>(&expectation.what))
    return failure_of(*texels, contents, expectation.name);
  return failure_of(std::get<BuffersExpectation>(expectation.what), contents, other, expectation.name);
}

}  // namespace tandem::program::amber
