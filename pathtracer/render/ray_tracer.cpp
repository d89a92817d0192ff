#include "pathtracer/render/ray_tracer.hpp"

#include <algorithm>
#include <cstddef>

#include "rhi/transfer.hpp"

namespace tandem::pathtracer {
namespace {

/// Bytes of rays that one dispatch takes at most.
constexpr std::uint64_t most_bytes = 64ull << 20;

}  // namespace

std::vector<std::uint32_t> trace(SceneOnDevice& scene, std::span<const TracedRay> rays) {
  const std::size_t batch = most_bytes / sizeof(TracedRay);
  std::vector<std::uint32_t> answers;
  answers.reserve(rays.size());
  for (std::size_t first = 0; first < rays.size(); first += batch) {
    const std::span<const TracedRay> some = rays.subspan(first, std::min(batch, rays.size() - first));
    const rhi::BufferHandle log = rhi::create_filled(scene.device(), some, rhi::BufferUsage::storage, "rays");
    const DispatchConstants constants{.tile_size = {some.size(), 1}, .sample_count = 0};
    scene.run(PathTraceTask::answer, {&log, 1}, {&constants, 1});
    for (const TracedRay& ray : rhi::read<TracedRay>(scene.device(), log, some.size())) answers.push_back(ray.answer);
  }
  return answers;
}

}  // namespace tandem::pathtracer
