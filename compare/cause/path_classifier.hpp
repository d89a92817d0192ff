#pragma once

#include <span>
#include <vector>

#include "compare/cause/divergence.hpp"
#include "pathtracer/render/path_event.hpp"
#include "pathtracer/render/scene_on_device.hpp"
#include "pathtracer/scene/scene.hpp"

/// Finds and classifies the divergences of single paths.
namespace tandem::compare {

/// The same scene under the same settings on three devices.
struct Devices {
  pathtracer::SceneOnDevice& a;
  pathtracer::SceneOnDevice& b;
  pathtracer::SceneOnDevice& arbiter;  ///< traces exactly
  const pathtracer::Scene& scene;      ///< as the devices were given it
};

/// The divergences of paths, observed fields included; one element for each path, in their order. All recordings are in
/// memory at once: some 20 KB a path.
std::vector<ClassifiedPath> classify_paths(const Devices& devices, std::span<const pathtracer::PathId> paths);
/// The same for callers with many batches of paths. @param scene that of the devices, in device order
std::vector<ClassifiedPath> classify_paths(const Devices& devices, const pathtracer::Scene& scene,
                                           std::span<const pathtracer::PathId> paths);

}  // namespace tandem::compare
