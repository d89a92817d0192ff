#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "pathtracer/render/renderer.hpp"
#include "pathtracer/scene/scene.hpp"
#include "rhi/device.hpp"
#include "tools/options/render_options.hpp"

/// From the options of a command to an image, for every command that renders.
namespace tandem::tools {

/// What is to be rendered, and how.
struct RenderJob {
  pathtracer::Scene scene;
  pathtracer::RenderSettings settings;
  std::uint32_t samples = 16;  ///< per pixel
};

/// Loads the scene, prints its warnings, and completes the options: by what the scene's file says, then by defaults. A
/// camera that is given in part is completed from that of the file or the automatic one; one that is only given a
/// position looks at the scene's centre.
RenderJob load_job(const RenderOptions& options);

/// Creates the device; what it has to say from warnings on goes to standard error, from any thread.
rhi::DeviceHandle open_device(const std::string& name, const RenderOptions& options);

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

/// Adds the samples with a progress bar. Throws Interrupted.
void render_samples(pathtracer::Renderer& renderer, std::uint32_t samples, const std::string& label);

/// Renders on the device, which is the renderer's, with a progress bar. Throws Interrupted.
Rendering render(pathtracer::Renderer& renderer, const rhi::DeviceInfo& device, std::uint32_t samples);

/// Millions a second.
double per_second_in_millions(double count, double milliseconds);

}  // namespace tandem::tools
