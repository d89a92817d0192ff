#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "pathtracer/render/render_settings.hpp"
#include "pathtracer/scene/scene.hpp"

namespace tandem::compare {

/// What is to be rendered, and how.
struct Job {
  pathtracer::Scene scene;
  pathtracer::RenderSettings settings;
  std::uint32_t samples = 16;  ///< per pixel
  std::filesystem::path file;  ///< of the scene, for reports; empty: the scene's name
};

/// What a report says of the scene and how it was rendered.
struct JobSummary {
  std::string scene;       ///< the file
  std::string scene_hash;  ///< of its content, as pathtracer::scene_hash gives it
  glm::dvec3 origin{0};    ///< of the scene: where its file has what is 0,0,0 in paths
  std::uint64_t triangles = 0;
  std::uint64_t spheres = 0;
  pathtracer::RenderSettings settings;
  std::uint32_t samples = 0;  ///< per pixel
};

JobSummary summary(const Job& job);

/// Throws Error unless a pixel is the mean of paths of its own, which can be recorded and judged.
void check_has_paths(const pathtracer::RenderSettings& settings);

}  // namespace tandem::compare
