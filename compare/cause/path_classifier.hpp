#pragma once

#include <span>
#include <vector>

#include "compare/cause/divergence.hpp"
#include "pathtracer/render/path_event.hpp"
#include "pathtracer/render/renderer.hpp"
#include "pathtracer/scene/scene.hpp"

/// Finds and classifies the divergences of single paths.
namespace tandem::compare {

/// Three renderers of the same scene and settings.
struct Devices {
  pathtracer::Renderer& a;
  pathtracer::Renderer& b;
  pathtracer::Renderer& arbiter;   ///< traces exactly
  const pathtracer::Scene& scene;  ///< as the renderers were given it
};

/// The divergences of paths, observed fields included; one element for each path, in their order. All recordings are in
/// memory at once: some 20 KB a path.
std::vector<ClassifiedPath> classify_paths(const Devices& devices, std::span<const pathtracer::PathId> paths);
/// The same for callers with many batches of paths. @param scene that of the devices, in device order
std::vector<ClassifiedPath> classify_paths(const Devices& devices, const pathtracer::Scene& scene,
                                           std::span<const pathtracer::PathId> paths);

}  // namespace tandem::compare
