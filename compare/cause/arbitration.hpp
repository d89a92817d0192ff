#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "compare/geometry/footprint.hpp"
#include "pathtracer/render/traced_ray.hpp"
#include "pathtracer/scene/scene.hpp"

/// Who is right when two devices give the same ray different answers: a third, exact one decides.
namespace tandem::compare {

/// A ray to which two devices gave different answers.
struct Dispute {
  pathtracer::TracedRay ray;
  std::uint32_t answer_a = 0;
  std::uint32_t answer_b = 0;
};

enum class Ruling {
  a_right,  ///< b's answer is wrong by more than rounding explains
  b_right,
  both_wrong,
  tie  ///< both answers are right within rounding
};

/// "a is right", "b is right", "both are wrong", "tie".
const char* name(Ruling ruling);

struct Arbitration {
  Ruling ruling = Ruling::tie;
  std::uint32_t exact_answer = 0;
};

/// Answers rays exactly: one answer for each, as TracedRay::answer has it.
using ExactTracer = std::function<std::vector<std::uint32_t>(std::span<const pathtracer::TracedRay> rays)>;

/// Arbitrates each dispute. An answer is right when it is the exact one. It is right within rounding when some ray that
/// differs from this one by no more than the tolerance has it exactly, or when the ray passes its triangle (not its
/// sphere) that closely, no farther away than the exact hit. The tolerance is tolerated_ulp
/// (compare/geometry/rounding.hpp) of the coordinates, but no more than a tenth of a pixel: what can be seen is no
/// rounding, however large the coordinates are. Two triangles that share the edge beside the ray are right where single
/// precision cannot tell its sides apart.
/// @param footprint of the picture that the rays belong to
std::vector<Arbitration> arbitrate(std::span<const Dispute> disputes, const pathtracer::Scene& scene,
                                   const PixelFootprint& footprint, const ExactTracer& trace);

}  // namespace tandem::compare
