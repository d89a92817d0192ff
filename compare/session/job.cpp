#include "compare/session/job.hpp"

#include "base/error.hpp"
#include "pathtracer/scene/hash.hpp"

namespace tandem::compare {

JobSummary summary(const Job& job) {
  return {.scene = job.file.empty() ? job.scene.name : job.file.string(),
          .scene_hash = pathtracer::scene_hash(job.scene),
          .origin = job.scene.origin,
          .triangles = job.scene.triangles.size(),
          .spheres = job.scene.spheres.size(),
          .settings = job.settings,
          .samples = job.samples};
}

void check_has_paths(const pathtracer::RenderSettings& settings) {
  if (settings.integrator == pathtracer::Integrator::metropolis)
    throw Error(
        "with integrator metropolis a pixel has no paths of its own that could be explained or classified: ask for "
        "them with integrator path");
}

}  // namespace tandem::compare
