#pragma once

#include "base/json_value.hpp"
#include "pathtracer/load/description/ranges.hpp"
#include "pathtracer/scene/camera.hpp"
#include "pathtracer/scene/settings.hpp"

namespace tandem::pathtracer::description {

/// Throws Error, also for a camera that looks nowhere. @param origin point of the description that the scene has at
/// 0,0,0
Camera read_camera(const Value& value, const glm::dvec3& origin);

/// Throws Error.
SceneSettings read_settings(const Value& value);

}  // namespace tandem::pathtracer::description
