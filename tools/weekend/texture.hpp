#pragma once

#include <cstdint>
#include <memory>

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "pathtracer/scene/scene.hpp"

namespace tandem::weekend {

/// Colour and alpha over the texture coordinates of a surface.
class Texture {
 public:
  virtual ~Texture() = default;
  virtual glm::dvec4 value(const glm::dvec2& uv) const = 0;
};

/// Throws Error for a kind that the baseline does not have: noise, a second set of coordinates.
std::unique_ptr<Texture> make_texture(const pathtracer::Scene& scene, std::uint32_t index);

/// The number that a texture's channel says of its value.
double channel_of(const pathtracer::Texture& texture, const glm::dvec4& value);

}  // namespace tandem::weekend
