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
      "A value differs by rounding, and nothing was decided by it.",
      "A ray passes an edge or a vertex within rounding, and each device took another of what meets there.",
      "A shadow ray grazes what is in its way, or is not.",
      "A choice, of a lobe, of roulette, of a side, lay within rounding of its threshold.",
      "Two surfaces lie in the same place, and each device took another.",
      "Rounding does not explain it: one of the devices is wrong."};
  return meanings[static_cast<std::size_t>(difference_class)];
}

}  // namespace tandem::compare
