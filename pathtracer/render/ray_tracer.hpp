#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pathtracer/render/scene_on_device.hpp"
#include "pathtracer/render/traced_ray.hpp"

namespace tandem::pathtracer {

/// The device's answers to rays that it may not have traced itself: TracedRay::answer of each, in their order.
std::vector<std::uint32_t> trace(SceneOnDevice& scene, std::span<const TracedRay> rays);

}  // namespace tandem::pathtracer
