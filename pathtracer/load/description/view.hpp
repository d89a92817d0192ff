#pragma once

#include "base/json_value.hpp"
#include "pathtracer/load/description/ranges.hpp"
#include "pathtracer/scene/camera.hpp"
#include "pathtracer/scene/settings.hpp"

namespace tandem::pathtracer::description {

/// Throws Error, also for a camera that looks nowhere.
Camera read_camera(const Value& value);

/// Throws Error.
SceneSettings read_settings(const Value& value);

}  // namespace tandem::pathtracer::description
