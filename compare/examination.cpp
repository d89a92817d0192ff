#include "compare/examination.hpp"

#include <algorithm>
#include <cstring>

#include "compare/difference.hpp"
#include "pathtracer/device_scene.hpp"

namespace tandem::compare {

std::uint64_t Examination::count(Ruling ruling) const {
  return static_cast<std::uint64_t>(
      std::ranges::count_if(disputes, [ruling](const JudgedDispute& each) { return each.judgement.ruling == ruling; }));
}

Examination examine(pathtracer::Renderer& a, pathtracer::Renderer& b, pathtracer::Renderer& arbiter,
                    const pathtracer::Image& image_a, const pathtracer::Image& image_b, std::uint32_t samples,
                    const pathtracer::Scene& scene, std::size_t limit) {
  Examination result;
  result.triangle_count = static_cast<std::uint32_t>(scene.triangles.size());
  std::vector<pathtracer::PathId> paths;
  for (const glm::uvec2& pixel : differing_pixels(image_a, image_b, limit, result.differing_pixels)) {
    ++result.examined_pixels;
    for (std::uint32_t sample = 0; sample < samples; ++sample) paths.push_back({.pixel = pixel, .sample = sample});
  }
  std::vector<pathtracer::PathStart> starts;
  for (const pathtracer::PathId& path : paths) starts.push_back({.path = path});
  const std::vector<pathtracer::PathEvents> log_a = a.record_paths(starts), log_b = b.record_paths(starts);
  std::vector<Dispute> disputes;
  for (std::size_t first = 0; first < paths.size(); first += samples) {
    bool parted = false;
    for (std::size_t i = first; i < first + samples; ++i) {
      const PathComparison comparison =
          compare_paths(paths[i], pathtracer::rays_of(paths[i], log_a[i]), pathtracer::rays_of(paths[i], log_b[i]));
      result.parted_by_dispute += comparison.parting == RayParting::dispute ? 1 : 0;
      result.parted_by_rounding += comparison.parting == RayParting::rounding ? 1 : 0;
      result.parted_by_length += comparison.parting == RayParting::length ? 1 : 0;
      parted = parted || comparison.parting != RayParting::none;
      if (comparison.dispute) disputes.push_back(*comparison.dispute);
    }
    if (!parted) ++result.unparted_pixels;
  }
  const std::vector<Judgement> judgements =
      arbitrate(disputes, pathtracer::in_device_order(scene),
                [&](std::span<const pathtracer::TracedRay> rays) { return arbiter.answer(rays); });
  for (std::size_t i = 0; i < disputes.size(); ++i) result.disputes.push_back({disputes[i], judgements[i]});
  return result;
}

}  // namespace tandem::compare
