#include "tools/program/difference_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "program/data/scalar.hpp"

namespace tandem::tools::program_run {
namespace {

using program::Place;
using Color = std::array<std::uint8_t, 3>;

constexpr Color equal = {0, 0, 0}, outside = {96, 96, 96}, not_a_number = {255, 0, 255};
constexpr std::array<Color, 7> decades = {
    {{30, 30, 150}, {30, 80, 255}, {0, 210, 230}, {0, 190, 60}, {250, 220, 0}, {230, 30, 20}, {255, 255, 255}}};

/// 0: equal bits; infinite where one is no number and the other is.
double relative_difference(const Place& place, std::span<const std::byte> a, std::span<const std::byte> b) {
  const std::uint64_t bits_a = program::bits_at(a, place), bits_b = program::bits_at(b, place);
  if (bits_a == bits_b) return 0;
  const double x = program::number_of(place.scalar, bits_a), y = program::number_of(place.scalar, bits_b);
  if (std::isnan(x) && std::isnan(y)) return 0;
  if (!std::isfinite(x) || !std::isfinite(y)) return std::numeric_limits<double>::infinity();
  // -0 against 0 has other bits, and whole numbers of 64 bits may round to the same double.
  return std::max(std::fabs(x - y) / std::max(std::fabs(x), std::fabs(y)), std::numeric_limits<double>::min());
}

Color color_of(double difference) {
  if (difference == 0) return equal;
  if (std::isinf(difference)) return not_a_number;
  constexpr double first_decade = -6;
  const double decade = std::isnan(difference) ? 0 : std::ceil(std::log10(difference) - first_decade);
  return decades[static_cast<std::size_t>(std::clamp(decade, 0.0, double{decades.size() - 1}))];
}

}  // namespace

DifferenceMap difference_map(const program::ValueType& type, std::span<const std::byte> a, std::span<const std::byte> b,
                             const std::array<std::uint32_t, 2>& size, std::uint64_t scalars_of_cell) {
  const std::size_t cells = std::size_t{size[0]} * size[1];
  std::vector<double> worst(cells, -1);
  std::uint64_t scalar = 0;
  program::for_each_place(type, a.size(), [&](const Place& place) {
    const std::uint64_t cell = scalar++ / scalars_of_cell;
    if (cell < cells) worst[cell] = std::max(worst[cell], relative_difference(place, a, b));
  });
  DifferenceMap map{.width = size[0], .height = size[1], .scalars_of_cell = scalars_of_cell};
  for (const double each : worst) {
    const Color color = each < 0 ? outside : color_of(each);
    map.rgb.insert(map.rgb.end(), color.begin(), color.end());
  }
  return map;
}

DifferenceMap difference_map(const program::ValueType& type, std::span<const std::byte> a,
                             std::span<const std::byte> b) {
  constexpr std::uint64_t longest = 128;
  const std::uint64_t count = std::max<std::uint64_t>(program::scalar_count(type, a.size()), 1);
  const std::uint64_t of_cell = (count + longest * longest - 1) / (longest * longest);
  const std::uint64_t cells = (count + of_cell - 1) / of_cell;
  const std::uint64_t width = std::min(cells, longest);
  return difference_map(type, a, b,
                        {static_cast<std::uint32_t>(width), static_cast<std::uint32_t>((cells + width - 1) / width)},
                        of_cell);
}

}  // namespace tandem::tools::program_run
