#include "pathtracer/render/path_event.hpp"

#include <cstddef>
#include <cstring>

namespace tandem::pathtracer {

bool PathSummary::operator==(const PathSummary& other) const {
  return std::memcmp(this, &other, offsetof(PathSummary, reserved)) == 0;
}

TracedRay ray_of(const PathId& path, const PathEvent& event) {
  return {.origin = event.vector(event_word::ray_origin),
          .t_max = event.number(event_word::ray_t_max),
          .direction = event.vector(event_word::ray_direction),
          .kind = static_cast<RayKind>(event.words[event_word::ray_kind]),
          .answer = event.words[event_word::ray_answer],
          .random_pixel = path.pixel.x + (path.pixel.y << 16),  // of the RandomKey in shaders/integrator/path.glsl
          .random_sample = path.sample,
          .random_dimension = event.words[event_word::ray_dimension]};
}

std::vector<TracedRay> rays_of(const PathId& path, std::span<const PathEvent> events) {
  std::vector<TracedRay> rays;
  for (const PathEvent& event : events)
    if (event.kind() == EventKind::ray) rays.push_back(ray_of(path, event));
  return rays;
}

}  // namespace tandem::pathtracer
