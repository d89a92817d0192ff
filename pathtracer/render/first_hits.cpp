#include "pathtracer/render/first_hits.hpp"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <span>

namespace tandem::pathtracer {
namespace {

/// FirstHit of shaders/first_hit.glsl.
struct GpuFirstHit {
  glm::vec3 albedo;
  float depth;
  glm::vec3 normal;
  float count;
  std::uint32_t primitive;
  std::uint32_t material;
  std::uint32_t reserved[2];
  glm::vec3 emission;
  std::uint32_t reserved_2;
};
static_assert(sizeof(GpuFirstHit) == 64);

/// Samples of every pixel that one submission looks at.
constexpr std::uint32_t batch = 4;

ImageChannel float_channel(const char* name, const std::vector<GpuFirstHit>& hits, auto value) {
  ImageChannel channel{.name = name, .is_integer = false, .words = {}};
  for (const GpuFirstHit& hit : hits) channel.words.push_back(std::bit_cast<std::uint32_t>(float{value(hit)}));
  return channel;
}

ImageChannel integer_channel(const char* name, const std::vector<GpuFirstHit>& hits, auto value) {
  ImageChannel channel{.name = name, .is_integer = true, .words = {}};
  for (const GpuFirstHit& hit : hits) channel.words.push_back(value(hit));
  return channel;
}

}  // namespace

std::vector<ImageChannel> first_hits(SceneOnDevice& scene, std::uint32_t samples) {
  const RenderSettings& settings = scene.settings();
  const std::size_t pixels = std::size_t{settings.width} * settings.height;
  const rhi::BufferHandle buffer = scene.device().create_buffer(
      {.size = pixels * sizeof(GpuFirstHit), .usage = rhi::BufferUsage::storage, .label = "first hits"});
  std::vector<DispatchConstants> dispatches;
  for (std::uint32_t first = 0; first < samples; first += batch)
    dispatches.push_back({.tile_size = {settings.width, settings.height},
                          .first_sample = first,
                          .sample_count = std::min(batch, samples - first)});
  scene.run(PathTraceTask::first_hit, {&buffer, 1}, dispatches);
  std::vector<GpuFirstHit> hits(pixels);
  scene.device().download(buffer, 0, std::as_writable_bytes(std::span(hits)));
  for (GpuFirstHit& hit : hits) {
    hit.albedo /= static_cast<float>(samples);
    hit.emission /= static_cast<float>(samples);
    if (hit.count == 0) continue;
    hit.normal /= hit.count;
    hit.depth /= hit.count;
  }
  return {float_channel("albedo.R", hits, [](const GpuFirstHit& hit) { return hit.albedo.x; }),
          float_channel("albedo.G", hits, [](const GpuFirstHit& hit) { return hit.albedo.y; }),
          float_channel("albedo.B", hits, [](const GpuFirstHit& hit) { return hit.albedo.z; }),
          float_channel("emission.R", hits, [](const GpuFirstHit& hit) { return hit.emission.x; }),
          float_channel("emission.G", hits, [](const GpuFirstHit& hit) { return hit.emission.y; }),
          float_channel("emission.B", hits, [](const GpuFirstHit& hit) { return hit.emission.z; }),
          float_channel("normal.X", hits, [](const GpuFirstHit& hit) { return hit.normal.x; }),
          float_channel("normal.Y", hits, [](const GpuFirstHit& hit) { return hit.normal.y; }),
          float_channel("normal.Z", hits, [](const GpuFirstHit& hit) { return hit.normal.z; }),
          float_channel("depth.Z", hits, [](const GpuFirstHit& hit) { return hit.depth; }),
          float_channel("coverage.Y", hits,
                        [&](const GpuFirstHit& hit) { return hit.count / static_cast<float>(samples); }),
          integer_channel("id.primitive", hits, [](const GpuFirstHit& hit) { return hit.primitive; }),
          integer_channel("id.material", hits, [](const GpuFirstHit& hit) { return hit.material; })};
}

}  // namespace tandem::pathtracer
