#include "compare/cause/divergence.hpp"

#include <algorithm>

namespace tandem::compare {

std::optional<DifferenceClass> ClassifiedPath::worst() const {
  std::optional<DifferenceClass> worst;
  for (const Divergence& divergence : divergences) worst = std::max(worst, std::optional(divergence.difference_class));
  return worst;
}

}  // namespace tandem::compare
