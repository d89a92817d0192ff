#pragma once

#include <bit>
#include <cstdint>

#include "pathtracer/render/path_event.hpp"

/// Events as a device might have recorded them.
namespace tandem::compare {

inline pathtracer::PathEvent event(pathtracer::EventKind kind, std::uint32_t segment = 0) {
  pathtracer::PathEvent result;
  result.words[0] = static_cast<std::uint32_t>(kind);
  result.words[1] = segment;
  return result;
}

inline pathtracer::PathEvent segment_event(std::uint32_t segment, const glm::vec3& origin, const glm::vec3& direction) {
  namespace word = pathtracer::event_word;
  pathtracer::PathEvent result = event(pathtracer::EventKind::segment, segment);
  result.words[word::segment_depth] = segment;
  result.set(word::segment_origin, origin);
  result.set(word::segment_direction, direction);
  result.set(word::segment_throughput, glm::vec3(0.5f, 0.25f, 0));
  result.set(word::segment_eta_scale, 1.0f);
  return result;
}

inline pathtracer::PathEvent ray_event(const glm::vec3& origin, const glm::vec3& direction, std::uint32_t answer,
                                       float t = 1, pathtracer::RayKind kind = pathtracer::RayKind::closest) {
  namespace word = pathtracer::event_word;
  pathtracer::PathEvent result = event(pathtracer::EventKind::ray);
  result.words[word::ray_kind] = static_cast<std::uint32_t>(kind);
  result.set(word::ray_origin, origin);
  result.set(word::ray_direction, direction);
  result.set(word::ray_t_max, kind == pathtracer::RayKind::closest ? 1e30f : 1.0f);
  result.words[word::ray_answer] = answer;
  const bool hit = kind == pathtracer::RayKind::closest && answer != pathtracer::no_primitive;
  result.words[word::hit_kind] =
      static_cast<std::uint32_t>(hit ? pathtracer::HitKind::front : pathtracer::HitKind::none);
  if (hit) result.set(word::hit_t, t);
  return result;
}

inline pathtracer::PathEvent roulette_event(float number, float survival, bool survives) {
  namespace word = pathtracer::event_word;
  pathtracer::PathEvent result = event(pathtracer::EventKind::roulette);
  result.words[word::roulette_bits] = static_cast<std::uint32_t>(number * 0x1p24f) << 8u;
  result.set(word::roulette_survival, survival);
  result.words[word::roulette_survives] = survives ? 1 : 0;
  return result;
}

inline pathtracer::PathEvent end_event(pathtracer::EndReason reason, const glm::vec3& radiance = glm::vec3(0)) {
  namespace word = pathtracer::event_word;
  pathtracer::PathEvent result = event(pathtracer::EventKind::end);
  result.words[word::end_reason] = static_cast<std::uint32_t>(reason);
  result.set(word::end_radiance, radiance);
  return result;
}

}  // namespace tandem::compare
