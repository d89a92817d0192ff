#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "base/progress.hpp"
#include "pathtracer/image/image.hpp"
#include "pathtracer/image/image_io.hpp"
#include "pathtracer/render/dispatch_plan.hpp"
#include "pathtracer/render/metropolis_picture.hpp"
#include "pathtracer/render/scene_on_device.hpp"

namespace tandem::pathtracer {

/// The picture of a scene that accumulates on a device.
///
/// Integrator metropolis is another matter: see MetropolisPicture, whose samples have the same property. Otherwise
/// a pixel is the sum of its samples 0, 1, 2, ... in that order, so the result depends neither on tiles nor on how
/// samples are spread over calls: render(16) and 16 times render(1) agree to the last bit.
class Renderer {
 public:
  /// As SceneOnDevice's constructor; also throws rhi::Error for a picture that is too large for the device.
  Renderer(rhi::DeviceHandle device, const Scene& scene, const RenderSettings& settings,
           std::optional<TracingMode> trace = {}, ProgramStoreHandle programs = {});

  /// Makes the program that renders, as render would otherwise when it is first called.
  void prepare();
  /// Also runs it once without a sample, as render would otherwise: some drivers compile a shader when it first runs,
  /// for minutes.
  void warm_up();

  /// Adds `samples` to every pixel. False when `progress` cancelled: the picture is then empty again.
  bool render(std::uint32_t samples, const Progress& progress = {});

  /// Empties the picture and renders with other settings from now on.
  void restart(const RenderSettings& settings);

  /// Empties the picture and renders with other lights from now on: see SceneOnDevice::set_lights.
  void set_lights(std::span<const PunctualLight> lights);

  /// The mean of the samples; black before the first.
  Image image() const;
  std::uint32_t samples() const noexcept { return samples_; }
  /// Rays traced for the samples of the picture, counted by the shader.
  std::uint64_t ray_count() const noexcept { return metropolis_ ? metropolis_->ray_count() : ray_count_; }
  /// Time that prepare and warm_up have taken since the last restart, by the host's clock: what compiling takes.
  double compile_milliseconds() const noexcept { return compile_milliseconds_; }
  /// Time that the dispatches took: by the device's timestamps where it has them, else by the host's clock.
  double device_milliseconds() const noexcept {
    return metropolis_ ? metropolis_->device_milliseconds() : device_milliseconds_;
  }

  /// The scene and the settings, for whatever else is asked of them on this device. Its settings are changed through
  /// the renderer only.
  SceneOnDevice& scene() noexcept { return scene_; }
  const SceneOnDevice& scene() const noexcept { return scene_; }
  /// scene, triangles, device, driver, trace, size, samples, depth, seed, camera, background, integrator, sampler,
  /// rays, milliseconds, version.
  ImageMetadata metadata() const;

 private:
  void record(rhi::CommandList& list, const DispatchConstants& constants);
  void dispatch(const Tile& tile, std::uint32_t first_sample, std::uint32_t sample_count);
  void clear_picture();
  void collect_ray_counts();

  SceneOnDevice scene_;
  std::optional<MetropolisPicture> metropolis_;  ///< of Integrator::metropolis, in place of the sums
  rhi::BindGroupHandle picture_group_;
  rhi::BufferHandle radiance_sum_, ray_counts_;
  std::uint32_t samples_ = 0;
  std::uint64_t ray_count_ = 0;
  double device_milliseconds_ = 0;
  double compile_milliseconds_ = 0;
  bool is_warm_ = false;
  Pace pace_{0.25};
};

}  // namespace tandem::pathtracer
