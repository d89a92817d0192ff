#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

#include "pathtracer/render/render_settings.hpp"
#include "tools/rendering.hpp"

namespace tandem::tools {

/// What a report says of the scene and how it was rendered.
struct JobSummary {
  std::string scene;       ///< the file
  std::string scene_hash;  ///< of its content, as pathtracer::scene_hash gives it
  std::uint64_t triangles = 0;
  std::uint64_t spheres = 0;
  pathtracer::RenderSettings settings;
  std::uint32_t samples = 0;  ///< per pixel
};

JobSummary summary(const RenderOptions& options, const RenderJob& job);

/// "scenes/cornell_box.obj (38 triangles)"
std::string scene_text(const JobSummary& job);

/// "512x512, 16 spp, depth 8, seed 0", and the options that are not the defaults.
std::string settings_text(const JobSummary& job);

/// All of it, for programs.
nlohmann::ordered_json to_json(const JobSummary& job);

/// The same, with what a renderer has chosen. Two jobs for which it is the same but for the name of the scene's file
/// are the same job.
nlohmann::ordered_json settings_json(const JobSummary& job, const pathtracer::Camera& camera,
                                     const glm::vec3& background);

}  // namespace tandem::tools
