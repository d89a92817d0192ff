#pragma once

#include <cstdint>
#include <vector>

#include "pathtracer/image/image_io.hpp"
#include "pathtracer/render/scene_on_device.hpp"

namespace tandem::pathtracer {

/// The AOVs of first hits, averaged over samples 0 to `samples` - 1: albedo, emission
/// (radiance of what is hit, or of what lies behind everything), normal (of shading, world space), depth
/// (distance), coverage (the fraction of samples that hit anything; the others count as albedo 0, and not at all for
/// normal and depth), and of sample 0 the primitive (triangles as the device numbers them, then spheres) and the
/// material, 2^32 - 1 for none. @param samples at least 1
std::vector<ImageChannel> first_hits(SceneOnDevice& scene, std::uint32_t samples);

}  // namespace tandem::pathtracer
