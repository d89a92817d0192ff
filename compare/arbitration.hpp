#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "pathtracer/path_event.hpp"
#include "pathtracer/scene.hpp"
#include "pathtracer/traced_ray.hpp"

/// Who is right when two devices give the same ray different answers: a third, exact one decides.
namespace tandem::compare {

/// The first ray of a path to which two devices gave different answers.
struct Dispute {
  pathtracer::PathId path;
  std::uint32_t ray_index = 0;  ///< of all rays of the path, shadow rays among them
  pathtracer::TracedRay ray;    ///< its answer is that of a
  std::uint32_t answer_a = 0;
  std::uint32_t answer_b = 0;
};

/// How the same path went on two devices.
enum class RayParting {
  none,      ///< the same rays and the same answers
  dispute,   ///< the same ray had two answers
  rounding,  ///< the rays themselves differ in some bit, though all answers before were the same
  length     ///< one path ended where the other went on, with the same rays before
};

struct PathComparison {
  RayParting parting = RayParting::none;
  std::optional<Dispute> dispute;  ///< of RayParting::dispute
};

/// @param a,b the rays of one path on two devices, in the order in which they were traced
PathComparison compare_paths(const pathtracer::PathId& path, std::span<const pathtracer::TracedRay> a,
                             std::span<const pathtracer::TracedRay> b);

enum class Ruling {
  a_right,  ///< b's answer is wrong by more than rounding explains
  b_right,
  both_wrong,
  tie  ///< both answers are right within rounding
};

/// "a is right", "b is right", "both are wrong", "tie".
const char* name(Ruling ruling);

struct Judgement {
  Ruling ruling = Ruling::tie;
  std::uint32_t exact_answer = 0;
};

/// Answers rays exactly: one answer for each, as TracedRay::answer has it.
using ExactTracer = std::function<std::vector<std::uint32_t>(std::span<const pathtracer::TracedRay> rays)>;

/// Judges each dispute. An answer is right when it is the exact one. It is right within rounding when some ray that
/// differs from this one by no more than 32 units in the last place of the largest coordinate involved has it exactly,
/// or when the ray passes its triangle (not its sphere) that closely, no farther away than the exact hit: backends
/// transform, clip and intersect in single precision, and 32 units is what the path tracer's own offset allows them
/// (shaders/geometry/offset_ray.glsl).
std::vector<Judgement> arbitrate(std::span<const Dispute> disputes, const pathtracer::Scene& scene,
                                 const ExactTracer& trace);

}  // namespace tandem::compare
