#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "compare/cause/difference_class.hpp"
#include "compare/path/event_fields.hpp"
#include "pathtracer/render/path_event.hpp"

/// What a classification finds in a path.
namespace tandem::compare {

/// A place where two devices do not do the same from the same inputs.
struct Divergence {
  DifferenceClass difference_class = DifferenceClass::mismatch;
  std::uint32_t segment = 0;
  std::size_t event_index = 0;        ///< in a's recording of the whole path
  pathtracer::PathEvent a, b;         ///< the events, of different kinds when that is how they part
  const EventField* field = nullptr;  ///< the first of a's kind that decides the class; null: the kinds differ
  std::uint32_t ulp_distance = 0;     ///< of the field
  double relative_difference = 0;     ///< likewise
  std::optional<std::uint32_t> exact_answer = {};  ///< of a ray with two answers: TracedRay::answer
  std::string sentence = {};                       ///< what happened, for people
};

/// A path that differs, or was looked at all the same.
struct ClassifiedPath {
  pathtracer::PathId path;
  std::vector<Divergence> divergences;  ///< in the order of the path; empty: none
  /// The worst of its divergences; none when there are none.
  std::optional<DifferenceClass> worst() const;
};

}  // namespace tandem::compare
