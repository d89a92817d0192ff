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
  /// Of the shaders, by the host's clock: little where the program or the driver had them already.
  double compile_milliseconds = 0.0;
  std::uint64_t rays = 0;  ///< counted
  pathtracer::ImageMetadata metadata;
  std::vector<std::string> warnings;
};

/// Makes a renderer's program: its first stage. Throws Cancelled.
void compile(pathtracer::Renderer& renderer, const StageProgress& progress = {});

/// Prepares the renderer and adds the samples to its picture. The stages of the progress are "compiling shaders for
/// NAME" and the device's NAME. Throws Cancelled.
Rendering render(pathtracer::Renderer& renderer, std::uint32_t samples, const StageProgress& progress = {});

}  // namespace tandem::compare
