#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/progress.hpp"
#include "pathtracer/image/image.hpp"
#include "pathtracer/render/dispatch_plan.hpp"
#include "pathtracer/render/scene_on_device.hpp"

namespace tandem::pathtracer {

/// Where chains begin: even ones and odd ones are two groups, independent of each other.
struct MetropolisStart {
  double scale = 0;                    ///< luminance that splats are weighted by; above 0 where there is light
  std::array<double, 2> brightness{};  ///< of each group, an estimate of the mean luminance of all paths
  std::vector<std::uint32_t> paths;    ///< the bootstrap path of each chain; empty: none has any light
};

/// Half of the bootstrap paths give the scale, a quarter each the brightness of a group and its chains' first paths by
/// resampling: each is chosen in proportion to its luminance (Veach, Robust Monte Carlo Methods for Light Transport
/// Simulation, 1997, section 11.3.1). So every state of a chain, times the brightness of its group, has the right
/// expectation, however few paths there are; and the scale, which the weights of splats depend on, is independent of
/// it.
/// @param luminances of the bootstrap paths, a multiple of 4 @param chains an even number @param seed of the resampling
MetropolisStart metropolis_start(std::span<const float> luminances, std::uint32_t chains, std::uint32_t seed);

/// A picture by Metropolis light transport in primary sample space (Kelemen et al. 2002), with many chains at once
/// (shaders/metropolis). One sample of a pixel is one mutation for each pixel of the picture. Mutation m of the picture
/// is mutation m / chains of chain m % chains, and what it adds is summed in integers, so the picture depends neither
/// on how mutations are spread over dispatches and calls nor on the order in which a device runs them.
///
/// With S_g the sum of what the chains of group g splat, over their number, and B_g the brightness that they began
/// with, B_g S_g has the right expectation. It is as bright as B_g by chance is, though, for as long as the picture
/// grows. So (L_g - B_g) S_h is added, where L_g is the brightness that the large steps of group g have found as well,
/// and h the other group: its expectation is 0, as the groups are independent, and all of L_g's paths tell the
/// brightness.
class MetropolisPicture {
 public:
  /// Makes program, buffers and bind groups. Throws rhi::Error.
  void prepare(SceneOnDevice& scene);
  /// Runs the program without a path.
  void warm_up(SceneOnDevice& scene);

  /// Adds mutations until the picture has `samples` for each pixel. False when `progress` cancelled: the picture is
  /// then lost. Throws Error for more mutations than the sums have room for.
  bool render(SceneOnDevice& scene, std::uint32_t samples, Pace& pace, const Progress& progress);

  /// After the mutations so far, which are `samples` for each pixel, at least 1.
  Image image(const SceneOnDevice& scene, std::uint32_t samples) const;
  std::uint64_t ray_count() const noexcept { return ray_count_; }  ///< of bootstrap and mutations
  double device_milliseconds() const noexcept { return device_milliseconds_; }

 private:
  /// Invocations of one dispatch.
  struct Range {
    std::uint32_t first;
    std::uint32_t count;
  };

  void dispatch(SceneOnDevice& scene, std::uint32_t stage, const Range& range, std::uint32_t first_step,
                std::uint32_t steps, Pace& pace);
  bool bootstrap(SceneOnDevice& scene, Pace& pace, const Progress& progress);
  void upload_constants(SceneOnDevice& scene, double scale);
  void collect_ray_counts(SceneOnDevice& scene);

  rhi::BufferHandle ray_counts_, splats_, chains_, bootstrap_, starts_, constants_, large_splats_, large_steps_;
  rhi::BindGroupHandle group_;
  bool has_started_ = false;
  double scale_ = 0;                    ///< luminance that splats are weighted by; 0: black
  std::array<double, 2> brightness_{};  ///< of MetropolisStart
  std::uint64_t mutations_ = 0;
  std::uint64_t ray_count_ = 0;
  double device_milliseconds_ = 0;
};

}  // namespace tandem::pathtracer
