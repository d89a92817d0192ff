#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "compare/session/job.hpp"

namespace tandem::tools {

/// "scenes/cornell_box.obj (38 triangles)"
std::string scene_text(const compare::JobSummary& job);

/// "512x512, 16 spp, depth 8, seed 0", and the options that are not the defaults.
std::string settings_text(const compare::JobSummary& job);

/// All of it, for programs.
nlohmann::ordered_json to_json(const compare::JobSummary& job);

/// The same, with what a renderer has chosen. Two jobs for which it is the same but for the name of the scene's file
/// are the same job.
nlohmann::ordered_json settings_json(const compare::JobSummary& job, const pathtracer::Camera& camera,
                                     const glm::vec3& background);

}  // namespace tandem::tools
