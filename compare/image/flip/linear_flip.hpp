#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "compare/image/flip/flip_errors.hpp"
#include "pathtracer/image/image.hpp"

/// The part that LDR and HDR share.
namespace tandem::compare {

/// A picture of linear RGB in [0, 1], row by row from the top left.
struct LinearPicture {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::vector<glm::dvec3> pixels;
};

/// The pixels of `image`; those that are not finite in it or in the other image are black.
LinearPicture finite_pixels(const pathtracer::Image& image, const pathtracer::Image& other);

/// The errors of [LDR] for two pictures of the same size.
std::vector<float> linear_flip(const LinearPicture& a, const LinearPicture& b, const ViewingConditions& viewing);

/// The errors with those of pixels that are not finite in both images set to 1, and their mean and maximum.
FlipErrors summarized(const pathtracer::Image& a, const pathtracer::Image& b, std::vector<float> errors);

}  // namespace tandem::compare
