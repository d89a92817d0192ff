#include "compare/session/rendering.hpp"

namespace tandem::compare {

void compile(pathtracer::Renderer& renderer, const StageProgress& progress) {
  const std::string stage = "compiling shaders for " + renderer.scene().device().info().name;
  if (progress && !progress(stage, 0)) throw Cancelled();
  renderer.warm_up();
  if (progress && !progress(stage, 1)) throw Cancelled();
}

Rendering render(pathtracer::Renderer& renderer, std::uint32_t samples, const StageProgress& progress) {
  const pathtracer::SceneOnDevice& scene = renderer.scene();
  const rhi::DeviceInfo& device = scene.device().info();
  compile(renderer, progress);
  // The clock of whoever shows the progress starts here: the first dispatch is part of what it estimates from.
  if (progress && !progress(device.name, 0)) throw Cancelled();
  if (!renderer.render(samples, stage_of(progress, device.name))) throw Cancelled();
  return {.image = renderer.image(),
          .device = device,
          .trace = scene.trace(),
          .camera = scene.camera(),
          .background = scene.background(),
          .milliseconds = renderer.device_milliseconds(),
          .build_milliseconds = scene.build_milliseconds(),
          .compile_milliseconds = renderer.compile_milliseconds(),
          .rays = renderer.ray_count(),
          .metadata = renderer.metadata(),
          .warnings = scene.warnings()};
}

}  // namespace tandem::compare
