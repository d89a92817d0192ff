#pragma once

#include <memory>
#include <vector>

#include "pathtracer/scene/scene.hpp"
#include "tools/weekend/hittable.hpp"
#include "tools/weekend/material.hpp"

namespace tandem::weekend {

/// A scene as the baseline sees it: objects, lights, and what is around them.
struct World {
  std::vector<std::unique_ptr<Material>> materials;
  std::shared_ptr<const Hittable> objects;              ///< all of them
  std::vector<std::shared_ptr<const Hittable>> lights;  ///< those that emit
  std::vector<pathtracer::PunctualLight> punctual;      ///< lights without extent
  glm::dvec3 background{0};                             ///< radiance of rays that leave the scene
  double nearest = 0;                                   ///< rays begin this far from where they start
};

/// Throws Error, naming the scene, for what the baseline does not have: media, moving or textured spheres, images as
/// environments, and what make_material refuses.
World make_world(const pathtracer::Scene& scene);

}  // namespace tandem::weekend
