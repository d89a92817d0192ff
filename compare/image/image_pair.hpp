#pragma once

#include <glm/vec3.hpp>

#include "pathtracer/image/image.hpp"

/// What all comparisons of two images share.
namespace tandem::compare {

/// Throws Error when the images differ in size, are empty, or do not hold width * height pixels.
void check_pair(const pathtracer::Image& a, const pathtracer::Image& b);

/// No channel is a NaN or an infinity.
bool is_finite(const glm::vec3& value);

/// All channels have the same bits; +0 and -0 do not.
bool is_bit_equal(const glm::vec3& a, const glm::vec3& b);

}  // namespace tandem::compare
