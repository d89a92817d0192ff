#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "pathtracer/render/device_scene.hpp"
#include "pathtracer/render/program_store.hpp"
#include "pathtracer/render/render_settings.hpp"
#include "pathtracer/render/tracing_mode.hpp"
#include "pathtracer/scene/camera.hpp"
#include "pathtracer/scene/scene.hpp"
#include "rhi/device.hpp"

namespace tandem::pathtracer {

/// A scene in the memory of a device, the settings under which it is seen, and the programs that do so: what pictures
/// (Renderer), recordings of paths (path_recorder.hpp), single rays (traced_ray.hpp) and AOVs (first_hits.hpp) have in
/// common. It has no picture. For one thread at a time.
class SceneOnDevice {
 public:
  /// Uploads the scene and builds its acceleration structures. Throws Error for bad settings, rhi::Error for what the
  /// device refuses (a tracing mode that it lacks, a scene that is too large).
  /// @param trace as choose_tracing_mode takes it
  /// @param programs of the same device, to share with other scenes; absent: the scene has its own
  SceneOnDevice(rhi::DeviceHandle device, const Scene& scene, const RenderSettings& settings,
                std::optional<TracingMode> trace = {}, ProgramStoreHandle programs = {});

  /// Other settings from now on. Builds no acceleration structure. Throws Error.
  void configure(const RenderSettings& settings);
  /// Other lights without extent from now on, in place of those that the scene came with. Builds no acceleration
  /// structure. Throws Error for numbers out of range; nothing has changed then.
  void set_lights(std::span<const PunctualLight> lights);

  rhi::Device& device() const noexcept { return *device_; }
  const std::string& name() const noexcept { return name_; }  ///< of the scene
  std::uint32_t triangle_count() const noexcept { return scene_.triangle_count(); }
  const RenderSettings& settings() const noexcept { return settings_; }
  TracingMode trace() const noexcept { return trace_; }
  const Camera& camera() const noexcept { return camera_; }                        ///< the one in use
  glm::vec3 background() const noexcept { return background_; }                    ///< the one in use
  const std::vector<std::string>& warnings() const noexcept { return warnings_; }  ///< choices the user may not expect
  /// Time that building the acceleration structures took: by the device's timestamps where it has them, else by the
  /// host's clock.
  double build_milliseconds() const noexcept { return build_milliseconds_; }
  /// Memory of the acceleration structures, in bytes.
  std::uint64_t structure_bytes() const { return scene_.structure_bytes(); }

  /// The program for the scene and its settings, made when it is first asked for.
  const PathTraceProgram& program(PathTraceTask task);
  /// Set 0 of the task's program.
  rhi::BindGroupHandle bind_group(PathTraceTask task);
  /// Runs a task over buffers that are bound from binding 2 of set 1 on, one submission for each dispatch.
  void run(PathTraceTask task, std::span<const rhi::BufferHandle> buffers,
           std::span<const DispatchConstants> dispatches);
  /// Executes a list, bracketed by timestamps where the device has them; returns milliseconds.
  double execute(const std::string& label, const std::function<void(rhi::CommandList&)>& record);

 private:
  rhi::DeviceHandle device_;
  ProgramStoreHandle programs_;
  std::string name_;
  Camera camera_;
  TracingMode trace_;
  DeviceScene scene_;
  RenderSettings settings_;
  Features features_ = ~Features{0};  ///< that are built in, for the scene and the settings
  glm::vec3 background_{0};
  std::vector<std::string> warnings_;
  rhi::BufferHandle constants_;  ///< one RenderConstants
  rhi::QueryPoolHandle timestamps_;
  std::map<PathTraceTask, rhi::BindGroupHandle> bind_groups_;  ///< until the scene's buffers or its programs change
  double build_milliseconds_ = 0;
};

}  // namespace tandem::pathtracer
