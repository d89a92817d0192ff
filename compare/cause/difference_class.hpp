#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace tandem::compare {

/// Why two devices differ somewhere, from the harmless to the one that must not be.
enum class DifferenceClass : std::uint32_t {
  /// The same to within the tolerance of a value; nothing was decided by it.
  rounding = 0,
  /// The ray passes an edge or a vertex within rounding, and each device took another of the primitives that meet
  /// there, or one of them none.
  edge_or_vertex_tie = 1,
  /// A shadow ray grazes what is or is not in its way.
  grazing_visibility = 2,
  /// A choice (of a lobe, a light, roulette, a side) lay within rounding of its threshold.
  flipped_decision = 3,
  /// Two primitives lie at the same distance within rounding, where the ray meets the inside of both.
  coincident_geometry = 4,
  /// Nothing of these: one of the devices is wrong.
  mismatch = 5
};
inline constexpr std::size_t difference_class_count = 6;

/// "rounding", "edge or vertex tie", "grazing visibility", "flipped decision", "coincident geometry", "mismatch".
const char* name(DifferenceClass difference_class);

/// Its colour in maps and reports, as sRGB 0xRRGGBB: cool ones for what rounding explains, red for a mismatch.
std::uint32_t color(DifferenceClass difference_class);

/// What it means, for people: a sentence.
const char* meaning(DifferenceClass difference_class);

/// How often each class occurred, by its number.
using ClassCounts = std::array<std::uint64_t, difference_class_count>;

}  // namespace tandem::compare
