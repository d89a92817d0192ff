#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>

#include "pathtracer/image/tone_map.hpp"
#include "pathtracer/render/tracing_mode.hpp"
#include "pathtracer/scene/settings.hpp"

namespace tandem::tools {

/// The options of every command that renders a scene: the scene, its view and the settings. Options that are not given
/// come from the scene file.
struct RenderOptions {
  std::filesystem::path scene;
  pathtracer::SceneSettings settings;         ///< but the size
  std::optional<glm::uvec2> size;             ///< pixels
  std::optional<glm::dvec3> camera_position;  ///< in the scene's units; none: that of the file, or the automatic camera
  std::optional<glm::dvec3> camera_target;
  std::optional<float> field_of_view;  ///< vertical, degrees
  std::optional<pathtracer::CameraKind> camera;
  std::optional<float> view_height;              ///< of an orthographic camera
  std::optional<float> lens_radius;              ///< in the scene's units
  std::optional<float> focus_distance;           ///< likewise
  std::uint32_t threads = 0;                     ///< of the CPU device; 0: all
  std::optional<pathtracer::TracingMode> trace;  ///< none: what the device has, ray queries first
  bool validation = false;                       ///< Vulkan validation layers
  bool thin_panes = false;                       ///< dielectrics whose mesh is not closed are sheets without thickness
  bool allow_outside_files = false;              ///< scenes name files anywhere
  bool allow_missing_mtl = false;                ///< a missing MTL file or texture is a warning
};

/// Declares SCENE and the options on the command. `options` must outlive the parsing.
void add_render_options(CLI::App& command, RenderOptions& options);

/// Declares how .png files show radiance.
void add_tone_options(CLI::App& command, pathtracer::Tone& tone);

/// An option whose value is the name of a form of tracing.
void add_tracing_mode(CLI::App& command, const std::string& name, std::optional<pathtracer::TracingMode>& value,
                      const std::string& description);

}  // namespace tandem::tools
