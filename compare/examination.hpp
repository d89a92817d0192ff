#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>

#include "compare/arbitration.hpp"
#include "pathtracer/image.hpp"
#include "pathtracer/renderer.hpp"

/// Why pixels of two pictures differ: their paths are traced again on both devices, ray by ray, and a third device
/// judges.
namespace tandem::compare {

/// A dispute and who is right in it.
struct JudgedDispute {
  Dispute dispute;
  Judgement judgement;
};

struct Examination {
  std::uint32_t triangle_count = 0;      ///< answers from this on name spheres
  std::uint64_t differing_pixels = 0;    ///< that are not bit-equal
  std::uint64_t examined_pixels = 0;     ///< of them; fewer when there are more than the limit
  std::uint64_t parted_by_dispute = 0;   ///< paths whose first difference is a ray with two answers
  std::uint64_t parted_by_rounding = 0;  ///< ... is a ray that has other bits, after equal answers
  std::uint64_t parted_by_length = 0;    ///< ... is that one of them ends
  std::uint64_t unparted_pixels = 0;     ///< examined pixels whose paths all trace the same rays with the same answers
  std::vector<JudgedDispute> disputes;   ///< in the order of pixels, then samples
  /// How many disputes ended so.
  std::uint64_t count(Ruling ruling) const;
};

/// The renderers have the same scene and settings; `image_a` and `image_b` are theirs after `samples` samples.
/// @param scene of the renderers
/// @param limit pixels to examine at most
Examination examine(pathtracer::Renderer& a, pathtracer::Renderer& b, pathtracer::Renderer& arbiter,
                    const pathtracer::Image& image_a, const pathtracer::Image& image_b, std::uint32_t samples,
                    const pathtracer::Scene& scene, std::size_t limit);

}  // namespace tandem::compare
