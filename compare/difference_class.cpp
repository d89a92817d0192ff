#include "compare/difference_class.hpp"

namespace tandem::compare {

const char* name(DifferenceClass difference_class) {
  static constexpr std::array<const char*, difference_class_count> names = {
      "rounding", "edge or vertex tie", "grazing visibility", "flipped decision", "coincident geometry", "mismatch"};
  return names[static_cast<std::size_t>(difference_class)];
}

}  // namespace tandem::compare
