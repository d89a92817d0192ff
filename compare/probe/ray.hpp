#pragma once

#include <span>
#include <vector>

#include "compare/probe/answer.hpp"
#include "compare/probe/reference.hpp"
#include "compare/probe/trial.hpp"
#include "pathtracer/render/path_event.hpp"
#include "pathtracer/render/scene_on_device.hpp"
#include "pathtracer/scene/scene.hpp"

namespace tandem::compare {

/// A ray of a path, to be asked again in every trial: its closest hit, whatever it was traced for.
struct PathRay {
  pathtracer::PathId path;
  std::uint32_t index = 0;  ///< of all rays of the path
  pathtracer::TracedRay ray;
};

/// At most `count` rays of the paths that sample 0 of pixels all over the picture takes on the renderer's device.
std::vector<PathRay> path_rays(pathtracer::SceneOnDevice& scene, std::size_t count);

/// Whether a probe can ask the ray: finite, with a direction.
bool is_askable(const pathtracer::TracedRay& ray);

/// `count` of the elements, spread evenly; all of them when there are no more.
std::vector<PathRay> spread_evenly(std::span<const PathRay> rays, std::size_t count);

/// The rays as a trial asks them: moved with the placement that they are aimed at, and cut to the trial's window about
/// what the reference says that they meet first.
/// @param rays is_askable
std::vector<ProbeRay> rays_of(const Trial& trial, std::span<const PathRay> rays, const ProbeReference& reference,
                              const pathtracer::Scene& scene);

}  // namespace tandem::compare
