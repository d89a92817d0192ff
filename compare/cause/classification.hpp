#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "base/progress.hpp"
#include "compare/cause/difference_class.hpp"
#include "compare/path/event_fields.hpp"
#include "pathtracer/image/image.hpp"
#include "pathtracer/render/path_event.hpp"
#include "pathtracer/render/scene_on_device.hpp"
#include "pathtracer/scene/scene.hpp"

/// Why two devices differ: paths are recorded on both, and every event in which they part is classed.
///
/// Device b runs each segment of a path from the state that a had at its beginning. Both then have the same inputs, bit
/// by bit, so each segment is judged by itself, however often they part on a path, and no error builds up. A segment's
/// answers to rays are judged by the exact arbiter; values by a tolerance, and, where that is not enough, like
/// decisions, by what either device makes of the same state moved by rounding (compare/cause/perturbation.hpp).
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

/// A pixel and the worst that was found in its paths.
struct ClassifiedPixel {
  glm::uvec2 pixel{0};
  DifferenceClass difference_class = DifferenceClass::mismatch;
  /// A picture that is not the sum of the paths that its own device records: 'a', 'b', or 0. A mismatch.
  char wrong_sum = 0;
};

struct ClassificationOptions {
  std::size_t pixel_limit = 10000;  ///< of the pixels that differ, at most so many are classed, spread evenly
  std::size_t survey_pixels = 256;  ///< besides, so many pixels all over the picture, sample 0, observed fields too
  /// No more pixels are looked at once so many paths have been recorded whole, or have mismatches: it bounds time.
  /// Pixels are looked at in an order that spreads evenly, too.
  std::size_t path_limit = 100000;
  std::size_t mismatch_limit = 1000;
};

struct Classification {
  std::uint64_t differing_pixels = 0;  ///< that are not bit-equal
  std::uint64_t classed_pixels = 0;    ///< of them
  std::uint64_t surveyed_pixels = 0;
  std::uint64_t traced_paths = 0;       ///< all samples of all these pixels, on each of the devices
  std::uint64_t differing_paths = 0;    ///< of them: in any bit of any event but observed fields
  ClassCounts pixel_counts{};           ///< classed pixels by their worst class
  ClassCounts divergence_counts{};      ///< all divergences, those of the survey included
  std::vector<ClassifiedPixel> pixels;  ///< classed ones, and surveyed ones with a mismatch, row by row
  std::vector<ClassifiedPath> paths;    ///< those with divergences, in the order of pixels, then samples
  std::uint64_t mismatches() const;     ///< paths with a mismatch, and pixels with a wrong sum
};

/// The same scene under the same settings on three devices.
struct Devices {
  pathtracer::SceneOnDevice& a;
  pathtracer::SceneOnDevice& b;
  pathtracer::SceneOnDevice& arbiter;   ///< traces exactly
  const pathtracer::Scene& scene;  ///< as the devices were given it
};

/// Classes the difference of two pictures. @param samples behind each pixel of both
/// @param progress of the work at most; cancelling it gives what is known so far
Classification classify(Devices devices, const pathtracer::Image& image_a, const pathtracer::Image& image_b,
                        std::uint32_t samples, const ClassificationOptions& options = {},
                        const Progress& progress = {});

/// The divergences of paths, observed fields included; one element for each path, in their order. All recordings are in
/// memory at once: some 20 KB a path.
std::vector<ClassifiedPath> classify_paths(Devices devices, std::span<const pathtracer::PathId> paths);

}  // namespace tandem::compare
