#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "compare/cause/arbitration.hpp"
#include "compare/cause/classification.hpp"
#include "compare/cause/perturbation.hpp"
#include "compare/path/divergence.hpp"
#include "pathtracer/render/path_event.hpp"
#include "pathtracer/scene/scene.hpp"

/// Judges one segment of a path, which two devices began with the same bits.
namespace tandem::compare {

/// The segment on both devices, and how far it has been judged.
struct JudgedSegment {
  pathtracer::PathId path;
  std::size_t first_event = 0;  ///< in a's recording of the whole path
  /// From the event of kind segment (of the camera: from its own) up to the one of the next segment or the end.
  std::span<const pathtracer::PathEvent> a;
  pathtracer::PathEvents b;

  EventPlace place = {};                     ///< what is before it has been judged
  bool has_rounding = false;                 ///< a divergence says so already
  std::vector<Divergence> divergences = {};  ///< in order
};

/// What the judgement of a segment waits for.
enum class Needed {
  nothing,     ///< it is done
  variations,  ///< of its state, to see what rounding can do
  arbiter      ///< of two answers to a ray, at `place`
};

/// Judges as far as can be without what is needed then. @param scene in device order
/// @param variations of the segment's state; null: not there yet. A camera has none, and is judged by tolerance alone.
Needed judge(JudgedSegment& segment, const pathtracer::Scene& scene, const Variations* variations);

/// Whether the segment begins with a state, rather than with the camera.
bool has_state(const JudgedSegment& segment);

/// The disputes that the segment's needs are about: one for rays with the same bits; two, each of an answer with
/// itself, for rays that rounding has moved.
std::vector<Dispute> disputes_of(const JudgedSegment& segment);

/// Ends the judgement of a segment with that of its disputes. @param scene in device order
void conclude(JudgedSegment& segment, const pathtracer::Scene& scene, std::span<const Judgement> judgements);

}  // namespace tandem::compare
