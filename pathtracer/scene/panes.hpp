#pragma once

#include <cstdint>
#include <vector>

#include "pathtracer/scene/scene.hpp"

namespace tandem::pathtracer {

/// The dielectric materials, smooth or rough, by ascending index, of whose triangles one has an edge that no other
/// triangle of the scene shares: light that enters such a mesh does not leave it. Vertices at the same place are one.
std::vector<std::uint32_t> open_dielectrics(const Scene& scene);

/// Makes panes of these materials: sheets without thickness, with the same index and tint (MaterialModel::thin).
void make_panes(Scene& scene, const std::vector<std::uint32_t>& materials);

}  // namespace tandem::pathtracer
