#pragma once

#include <optional>

#include "base/json_value.hpp"
#include "pathtracer/load/description/ranges.hpp"
#include "pathtracer/load/description/textures.hpp"
#include "pathtracer/scene/scene.hpp"

namespace tandem::pathtracer::description {

/// Adds what "lights" lists: point, spot and directional lights, and rectangles and spheres that emit. Throws Error.
void add_lights(const std::optional<Value>& list, Scene& scene);

/// Throws Error.
Environment read_environment(const Value& value, Textures& textures);

}  // namespace tandem::pathtracer::description
