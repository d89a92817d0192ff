#include "compare/cause/difference_class.hpp"

namespace tandem::compare {

const char* name(DifferenceClass difference_class) {
  static constexpr std::array<const char*, difference_class_count> names = {
      "rounding", "edge or vertex tie", "grazing visibility", "flipped decision", "coincident geometry", "mismatch"};
  return names[static_cast<std::size_t>(difference_class)];
}

std::uint32_t color(DifferenceClass difference_class) {
  static constexpr std::array<std::uint32_t, difference_class_count> colors = {0x4477aa, 0x66ccee, 0x228833,
                                                                               0xccbb44, 0xaa3377, 0xff2020};
  return colors[static_cast<std::size_t>(difference_class)];
}

const char* meaning(DifferenceClass difference_class) {
  static constexpr std::array<const char*, difference_class_count> meanings = {
      "A value differs by rounding, but decides nothing.",
      "A ray passes an edge or a vertex within rounding, and the devices report different primitives there.",
      "A shadow ray grazes an occluder within rounding.",
      "A choice (of a lobe, a light, a side, roulette) lies within rounding of its threshold.",
      "Two surfaces lie in the same place, and the devices report different ones.",
      "Rounding does not explain the difference: one of the devices is wrong."};
  return meanings[static_cast<std::size_t>(difference_class)];
}

}  // namespace tandem::compare
