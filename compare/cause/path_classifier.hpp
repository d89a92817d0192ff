#pragma once

#include <span>
#include <vector>

#include "compare/cause/classification.hpp"
#include "pathtracer/render/path_event.hpp"
#include "pathtracer/scene/scene.hpp"

namespace tandem::compare {

/// As classify_paths. @param scene of the devices, in device order
std::vector<ClassifiedPath> judge_paths(const Devices& devices, const pathtracer::Scene& scene,
                                        std::span<const pathtracer::PathId> paths);

/// Whether two recordings are the same, observed fields aside.
bool is_same(const pathtracer::PathSummary& a, const pathtracer::PathSummary& b);

}  // namespace tandem::compare
