#pragma once

#include <optional>

#include "pathtracer/description/textures.hpp"
#include "pathtracer/description/value.hpp"
#include "pathtracer/scene.hpp"

namespace tandem::pathtracer::description {

/// Adds what "lights" lists: point, spot and directional lights, and rectangles and spheres that emit. Throws Error.
void add_lights(const std::optional<Value>& list, Scene& scene);

/// Throws Error.
Environment read_environment(const Value& value, Textures& textures);

}  // namespace tandem::pathtracer::description
