#include "compare/session/job.hpp"

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

}  // namespace tandem::compare
