#pragma once

#include <glm/vec3.hpp>

/// The colour spaces in which FLIP works, all relative to the white of linear RGB (1, 1, 1), which is D65.
namespace tandem::compare {

/// Opponent colours, linear in the light: achromatic Y, red-green Cx and blue-yellow Cz, which are the L*, a* and b* of
/// CIELAB without their cube roots ([LDR] section 4.1).
glm::dvec3 ycxcz_of_linear_rgb(const glm::dvec3& rgb);
glm::dvec3 linear_rgb_of_ycxcz(const glm::dvec3& ycxcz);

/// CIELAB (CIE 15:2004, section 8.2.1), whose distances are those that an eye sees, roughly.
glm::dvec3 lab_of_linear_rgb(const glm::dvec3& rgb);

/// CIELAB with a* and b* times L* / 100, because colours of dark things look less colourful (the effect that Hunt
/// described; [LDR] section 4.1).
glm::dvec3 hunt_lab_of_linear_rgb(const glm::dvec3& rgb);

/// Distance of two colours in CIELAB: city-block in L*, Euclidean in a* and b* (Abasi, Amani Tehran and Fairchild,
/// Distance Metrics for Very Large Color Differences, 2020).
double hyab_distance(const glm::dvec3& a, const glm::dvec3& b);

}  // namespace tandem::compare
