#pragma once

#include "pathtracer/camera.hpp"
#include "pathtracer/description/value.hpp"
#include "pathtracer/scene_settings.hpp"

namespace tandem::pathtracer::description {

/// Throws Error, also for a camera that looks nowhere.
Camera read_camera(const Value& value);

/// Throws Error.
SceneSettings read_settings(const Value& value);

}  // namespace tandem::pathtracer::description
