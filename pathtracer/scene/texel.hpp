#pragma once

#include <cstddef>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "pathtracer/scene/scene.hpp"

namespace tandem::pathtracer {

/// The linear r, g, b and alpha of a texel, as the shader reads it. @param index row by row from the top
glm::vec4 texel_at(const TextureImage& image, std::size_t index);

/// The mean colour of a texture over its image, or of a pigment over all places. The channel is ignored.
glm::vec3 mean_color(const Scene& scene, const Texture& texture);

}  // namespace tandem::pathtracer
