#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "compare/cause/arbitration.hpp"
#include "compare/cause/divergence.hpp"
#include "compare/cause/perturbation.hpp"
#include "compare/path/recording_difference.hpp"
#include "pathtracer/render/path_event.hpp"
#include "pathtracer/scene/scene.hpp"

/// Classifies the differences in one segment of a path, which two devices began with the same bits.
namespace tandem::compare {

/// The segment on both devices, and how far it has been classified.
struct ClassifiedSegment {
  pathtracer::PathId path;
  std::size_t first_event = 0;  ///< in a's recording of the whole path
  /// From the event of kind segment (of the camera: from its own) up to the one of the next segment or the end.
  std::span<const pathtracer::PathEvent> a;
  pathtracer::PathEvents b;

  EventPlace place = {};                     ///< what is before it has been classified
  bool has_rounding = false;                 ///< a divergence says so already
  std::vector<Divergence> divergences = {};  ///< in order
};

/// What the classification of a segment waits for.
enum class Pending {
  nothing,     ///< it is done
  variations,  ///< of its state, to see what rounding can do
  arbiter      ///< of two answers to a ray, at `place`
};

/// Classifies differences up to the first that waits for something, and says for what. @param scene in device order
/// @param variations of the segment's state; null: not there yet. A camera has none: its values are held to their
/// tolerance alone.
Pending classify_segment(ClassifiedSegment& segment, const pathtracer::Scene& scene, const Variations* variations);

/// Whether the segment begins with a state, rather than with the camera.
bool has_state(const ClassifiedSegment& segment);

/// The disputes that a segment waits for with Pending::arbiter: one for rays with the same bits; two, each of an answer
/// with itself, for rays that rounding has moved.
std::vector<Dispute> disputes_of(const ClassifiedSegment& segment);

/// Classifies the difference that waits for the arbiter, by the arbitrations of disputes_of, and ends the segment.
/// @param scene in device order
void resolve(ClassifiedSegment& segment, const pathtracer::Scene& scene, std::span<const Arbitration> arbitrations);

}  // namespace tandem::compare
