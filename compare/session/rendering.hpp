#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/progress.hpp"
#include "pathtracer/render/renderer.hpp"

namespace tandem::compare {

/// A finished picture and how it came about.
struct Rendering {
  pathtracer::Image image;
  rhi::DeviceInfo device;
  pathtracer::TracingMode trace = pathtracer::TracingMode::query;
  pathtracer::Camera camera;
  glm::vec3 background{0};
  double milliseconds = 0.0;        ///< on the device, without building
  double build_milliseconds = 0.0;  ///< of the acceleration structures
  std::uint64_t rays = 0;           ///< counted
  pathtracer::ImageMetadata metadata;
  std::vector<std::string> warnings;
};

/// Adds the samples to the renderer's picture. The stage of the progress is the device's name. Throws Cancelled.
Rendering render(pathtracer::Renderer& renderer, std::uint32_t samples, const StageProgress& progress = {});

}  // namespace tandem::compare
