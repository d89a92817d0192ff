#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "pathtracer/render/render_settings.hpp"
#include "pathtracer/render/renderer.hpp"
#include "pathtracer/scene/scene.hpp"
#include "rhi/device.hpp"

/// What each sampler and each option of the integrator is worth: error, variance, time and order of convergence,
/// against a picture of many samples.
namespace tandem::study {

/// A way to render. What is not said is as in RenderSettings.
struct Method {
  std::string name;
  pathtracer::SamplerKind sampler = pathtracer::SamplerKind::independent;
  bool light_sampling = true;
  pathtracer::Mis mis = pathtracer::Mis::power;
  pathtracer::BsdfSampling bsdf_sampling = pathtracer::BsdfSampling::bsdf;
  bool roulette = true;
};

/// The methods of the table: the samplers, then the options of the integrator with independent samples.
std::vector<Method> methods();

/// How the thesis renders: no next event estimation, cosine sampling, independent samples, no roulette.
Method thesis_method();
/// Next event estimation, multiple importance sampling, Sobol samples.
Method best_method();

struct StudySettings {
  std::uint32_t size = 64;  ///< pixels, each way
  std::uint32_t max_depth = 8;
  std::vector<std::uint32_t> sample_counts = {4, 16, 64, 256};  ///< ascending, at least two
  std::uint32_t reference_samples = 16384;
};

/// One picture.
struct Measurement {
  std::uint32_t samples = 0;
  double rmse = 0;     ///< against the reference, over pixels and channels
  double seconds = 0;  ///< of the device
};

struct MethodResult {
  Method method;
  std::vector<Measurement> measurements;  ///< in the order of the sample counts

  double slope() const;       ///< of log RMSE over log samples
  double variance() const;    ///< of one sample: the square of the RMSE of the last picture, times its samples
  double efficiency() const;  ///< 1 / (V T) of the last picture: its squared RMSE and its seconds
};

/// How many times fewer samples the best method needs for the error that the thesis's has.
struct SampleRatio {
  MethodResult thesis;
  MethodResult best;
  /// The thesis's last sample count over the count with which the best method reaches its error, on the polyline
  /// through the logarithms of the measurements; none when no measured count reaches it. Where even the first does, its
  /// count.
  std::optional<double> ratio() const;
};

/// Scene by scene.
struct SceneResult {
  std::string scene;
  std::vector<MethodResult> methods;
  std::optional<SampleRatio> sample_ratio;
};

/// Measures `methods` in the scene. Throws what Renderer throws. @return nothing when `progress` cancelled
/// @param compares_thesis whether to measure the sample ratio too
std::optional<SceneResult> study_scene(const rhi::DeviceHandle& device, const pathtracer::Scene& scene,
                                       const std::vector<Method>& methods, const StudySettings& settings,
                                       bool compares_thesis, const Progress& progress = {});

}  // namespace tandem::study
