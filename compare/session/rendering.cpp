#include "compare/session/rendering.hpp"

namespace tandem::compare {

Rendering render(pathtracer::Renderer& renderer, std::uint32_t samples, const StageProgress& progress) {
  const pathtracer::SceneOnDevice& scene = renderer.scene();
  const rhi::DeviceInfo& device = scene.device().info();
  if (!renderer.render(samples, stage_of(progress, device.name))) throw Cancelled();
  return {.image = renderer.image(),
          .device = device,
          .trace = scene.trace(),
          .camera = scene.camera(),
          .background = scene.background(),
          .milliseconds = renderer.device_milliseconds(),
          .build_milliseconds = scene.build_milliseconds(),
          .rays = renderer.ray_count(),
          .metadata = renderer.metadata(),
          .warnings = scene.warnings()};
}

}  // namespace tandem::compare
