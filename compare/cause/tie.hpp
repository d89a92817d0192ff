#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "compare/cause/difference_class.hpp"
#include "pathtracer/render/path_event.hpp"
#include "pathtracer/render/traced_ray.hpp"
#include "pathtracer/scene/scene.hpp"

/// What kind of tie it is when two answers to a ray are both right within rounding, and what rounding allows a device
/// to report of a hit.
namespace tandem::compare {

/// The class of a tie. Of an occlusion ray it is grazing visibility. Of a closest ray that meets the inside of both
/// primitives: coincident geometry if both are at the same distance; if not, the nearer one let the ray through, which
/// is a decision. Else an edge or a vertex.
/// @param scene in device order @param answer_a,answer_b as TracedRay::answer has them
DifferenceClass class_of_tie(const pathtracer::Scene& scene, const pathtracer::TracedRay& ray, std::uint32_t answer_a,
                             std::uint32_t answer_b);

/// How a ray passes the primitives of a tie: "they share an edge, and it passes 3e-06 from it". Empty when there is
/// nothing to say.
/// @param scene in device order
std::string passing_text(const pathtracer::Scene& scene, const pathtracer::TracedRay& ray, std::uint32_t answer_a,
                         std::uint32_t answer_b);

/// Whether a t or a pair of barycentrics that two devices report of the same hit may both come from rounding: within
/// the tolerance of the contract, or, where the triangle is far, thin, or seen at a grazing angle, within what
/// tolerated_ulp units in the last place of the largest coordinate make of them there
/// (compare/geometry/intersection.hpp).
/// @param scene in device order @param field hit_t or hit_barycentrics of pathtracer::event_word
bool is_report_within_rounding(const pathtracer::Scene& scene, const pathtracer::PathEvent& a,
                               const pathtracer::PathEvent& b, std::size_t field, double tolerance);

}  // namespace tandem::compare
