#pragma once

#include <span>
#include <vector>

#include "pathtracer/render/path_event.hpp"
#include "pathtracer/render/scene_on_device.hpp"

/// Paths one by one: what the comparison of devices asks for when their pictures differ.
namespace tandem::pathtracer {

/// What becomes of each path under the scene's settings on its device.
std::vector<PathSummary> summarize_paths(SceneOnDevice& scene, std::span<const PathStart> starts);

/// The events of each path, all of them, in order. 128 bytes each: ask for no more paths than memory holds.
std::vector<PathEvents> record_paths(SceneOnDevice& scene, std::span<const PathStart> starts);

}  // namespace tandem::pathtracer
