#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>

#include "pathtracer/trace_form.hpp"

namespace tandem::tools {

/// What render, diff and bench have in common: a scene and how it is seen.
struct RenderOptions {
  std::filesystem::path scene;
  glm::uvec2 size = {512, 512};  ///< pixels
  std::uint32_t samples = 16;    ///< per pixel
  std::uint32_t depth = 8;       ///< path segments from the camera on
  std::uint32_t seed = 0;
  std::optional<glm::vec3> camera_position;  ///< in the scene's units; none: the automatic camera
  std::optional<glm::vec3> camera_target;
  std::optional<float> field_of_view;          ///< vertical, degrees
  std::optional<glm::vec3> background;         ///< radiance
  std::uint32_t threads = 0;                   ///< of the CPU device; 0: all
  std::optional<pathtracer::TraceForm> trace;  ///< none: what the device has, ray queries first
  bool validation = false;                     ///< Vulkan validation layers
  bool allow_missing_mtl = false;              ///< a missing MTL file or texture is a warning
};

/// Declares SCENE and the options on the command. `options` must outlive the parsing.
void add_render_options(CLI::App& command, RenderOptions& options);

/// An option whose value is the name of a form of tracing.
void add_trace_form(CLI::App& command, const std::string& name, std::optional<pathtracer::TraceForm>& value,
                    const std::string& description);

}  // namespace tandem::tools
