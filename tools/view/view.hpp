#pragma once

#include <cstdint>
#include <vector>

#include "pathtracer/render/accumulation.hpp"
#include "pathtracer/render/render_settings.hpp"
#include "pathtracer/scene/scene.hpp"

namespace tandem::view {

/// What a picture in the window depends on, beside the scene and the device.
struct View {
  pathtracer::RenderSettings settings;  ///< its camera is set
  std::vector<pathtracer::PunctualLight> lights;
  pathtracer::AccumulationSettings accumulation;
};

}  // namespace tandem::view
