#pragma once

#include <cstdint>
#include <span>

#include "rhi_cpu/trace/embree/scene.hpp"

namespace tandem::cpu {

/// kernel::TraceFunctions::next_hits, into `hits`.
std::uint32_t gather_candidates(const TopLevelScene& scene, const kernel::Ray& ray, const kernel::Hit* previous,
                                std::span<kernel::Hit> hits);

/// The first of the triangles, as Embree finds them.
std::uint32_t gather_triangles(const TopLevelScene& scene, const kernel::Ray& ray, std::span<kernel::Hit> hits);

/// kernel::TraceFunctions::visit.
bool visit_candidates(const TopLevelScene& scene, const kernel::Ray& ray, const kernel::CandidateVisitor& visitor,
                      kernel::Hit& committed);

}  // namespace tandem::cpu
