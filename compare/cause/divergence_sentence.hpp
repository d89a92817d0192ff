#pragma once

#include <cstdint>
#include <string>

#include "compare/cause/divergence.hpp"
#include "pathtracer/render/traced_ray.hpp"
#include "pathtracer/scene/scene.hpp"

/// What happened where two devices part, for people: a sentence or two.
namespace tandem::compare {

/// Of a divergence that is not about a ray's answer.
std::string sentence_of(const Divergence& divergence);

/// Of one that is. @param scene in device order
std::string sentence_of_answers(const Divergence& divergence, const pathtracer::Scene& scene,
                                const pathtracer::PathId& path);

/// "triangle 17", "sphere 2", "nothing"; of an occlusion ray "something" or "nothing". @param scene in device order
std::string answer_text(const pathtracer::Scene& scene, pathtracer::RayKind kind, std::uint32_t answer);

}  // namespace tandem::compare
