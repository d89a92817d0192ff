#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "pathtracer/image/image.hpp"
#include "pathtracer/image/image_io.hpp"
#include "pathtracer/render/device_scene.hpp"
#include "pathtracer/render/dispatch_plan.hpp"
#include "pathtracer/render/path_event.hpp"
#include "pathtracer/render/program_store.hpp"
#include "pathtracer/render/render_settings.hpp"
#include "pathtracer/render/traced_ray.hpp"
#include "pathtracer/render/tracing_mode.hpp"
#include "pathtracer/scene/camera.hpp"
#include "pathtracer/scene/scene.hpp"
#include "rhi/device.hpp"

namespace tandem::pathtracer {

/// Called between submissions with the finished fraction of the call, in [0, 1]; false cancels.
using Progress = std::function<bool(double fraction)>;

/// A scene on a device, and the picture of it that accumulates there.
///
/// A pixel is the sum of its samples 0, 1, 2, ... in that order, so the result depends neither on tiles nor on how
/// samples are spread over calls: render(16) and 16 times render(1) agree to the last bit.
class Renderer {
 public:
  /// Uploads the scene and builds its acceleration structures. Throws Error for bad settings, rhi::Error for what the
  /// device refuses (a form of tracing that it lacks, a scene or picture that is too large).
  /// @param trace as choose_tracing_mode takes it
  /// @param programs of the same device, to share with other renderers; absent: the renderer creates its own
  Renderer(rhi::DeviceHandle device, const Scene& scene, const RenderSettings& settings,
           std::optional<TracingMode> trace = {}, ProgramStoreHandle programs = {});

  /// Makes what only render needs, as render would otherwise when it is first called: the program that renders. Throws
  /// rhi::Error for a picture that is too large for the device.
  void prepare();

  /// Adds `samples` to every pixel. False when `progress` cancelled: the picture is then empty again.
  bool render(std::uint32_t samples, const Progress& progress = {});

  /// Empties the picture and renders with other settings from now on.
  void restart(const RenderSettings& settings);

  /// Empties the picture and renders with other lights without extent from now on, in the place of those that the scene
  /// came with. Builds no acceleration structure. Throws Error for numbers out of range; nothing has changed then.
  void set_lights(std::span<const PunctualLight> lights);

  /// The mean of the samples; black before the first.
  Image image() const;
  std::uint32_t samples() const noexcept { return samples_; }
  /// Rays traced for the samples of the picture, counted by the shader.
  std::uint64_t ray_count() const noexcept { return ray_count_; }
  /// Time that the dispatches took: by the device's timestamps where it has them, else by the host's clock.
  double device_milliseconds() const noexcept { return device_milliseconds_; }
  /// Time that building the acceleration structures took, likewise.
  double build_milliseconds() const noexcept { return build_milliseconds_; }

  const RenderSettings& settings() const noexcept { return settings_; }
  TracingMode trace() const noexcept { return trace_; }
  const Camera& camera() const noexcept { return camera_; }                        ///< the one in use
  glm::vec3 background() const noexcept { return background_; }                    ///< the one in use
  const std::vector<std::string>& warnings() const noexcept { return warnings_; }  ///< choices the user may not expect
  /// scene, triangles, device, driver, trace, size, samples, depth, seed, camera, background, integrator, sampler,
  /// rays, milliseconds, version.
  ImageMetadata metadata() const;

  /// What pixels show first, averaged over samples 0 to `samples` - 1: albedo, normal (of shading, world space), depth
  /// (distance), coverage (the fraction of samples that hit anything; the others count as albedo 0, and not at all for
  /// normal and depth), and of sample 0 the primitive (triangles as the device numbers them, then spheres) and the
  /// material, 2^32 - 1 for none. Changes nothing. @param samples at least 1
  std::vector<ImageChannel> first_hits(std::uint32_t samples);

  /// What becomes of each path under the settings on this device. Changes nothing.
  std::vector<PathSummary> summarize_paths(std::span<const PathStart> starts);
  /// The events of each path, all of them, in order. Changes nothing. 128 bytes each: ask for no more paths than memory
  /// holds.
  std::vector<PathEvents> record_paths(std::span<const PathStart> starts);
  /// This device's answers to rays that it may not have traced itself.
  std::vector<std::uint32_t> answer(std::span<const TracedRay> rays);

 private:
  /// Runs a task over buffers that are bound from binding 2 of set 1 on, one submission for each dispatch.
  void run_task(PathTraceTask task, const std::vector<rhi::BufferHandle>& buffers,
                std::span<const DispatchConstants> dispatches);
  /// Records paths that fit into one submission, of each as many events as `capacities` says, one after the other.
  std::vector<PathSummary> record(std::span<const PathStart> starts, std::span<const std::uint32_t> capacities,
                                  PathEvents& events);
  /// Executes the list, bracketed by timestamps where the device has them; returns milliseconds.
  double execute(const std::string& label, const std::function<void(rhi::CommandList&)>& record);
  void dispatch(const Tile& tile, std::uint32_t first_sample, std::uint32_t sample_count);
  const PathTraceProgram& program(PathTraceTask task);
  void choose_features(const RenderSettings& settings);
  void clear_picture();
  void collect_ray_counts();

  rhi::DeviceHandle device_;
  ProgramStoreHandle programs_;
  std::string scene_name_;
  Camera camera_;
  TracingMode trace_;
  DeviceScene scene_;
  RenderSettings settings_;
  Features features_ = ~Features{0};  ///< that are built in, for the scene and the settings
  glm::vec3 background_{0};
  std::vector<std::string> warnings_;

  rhi::BindGroupHandle scene_group_, picture_group_;
  rhi::BufferHandle constants_buffer_, radiance_sum_, ray_counts_;
  rhi::QueryPoolHandle timestamps_;

  RenderConstants constants_{};
  std::uint32_t samples_ = 0;
  std::uint64_t ray_count_ = 0;
  double device_milliseconds_ = 0;
  double build_milliseconds_ = 0;
  Pace pace_{0.25};
};

}  // namespace tandem::pathtracer
