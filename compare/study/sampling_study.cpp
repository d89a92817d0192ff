#include "compare/study/sampling_study.hpp"

#include <cmath>

#include "compare/metrics/metrics.hpp"
#include "compare/study/convergence.hpp"

namespace tandem::study {
namespace {

using pathtracer::BsdfSampling;
using pathtracer::Image;
using pathtracer::Mis;
using pathtracer::RenderSettings;
using pathtracer::SamplerKind;

// That of the reference is another, so that no picture shares its random numbers.
constexpr std::uint32_t seed = 1;
constexpr std::uint32_t reference_seed = 0x7e1a;

RenderSettings render_settings(const Method& method, const StudySettings& study, std::uint32_t samples) {
  RenderSettings settings;
  settings.width = study.size;
  settings.height = study.size;
  settings.max_depth = study.max_depth;
  settings.seed = seed;
  settings.sampler = method.sampler;
  settings.planned_samples = samples;
  settings.light_sampling = method.light_sampling;
  settings.mis = method.mis;
  settings.bsdf_sampling = method.bsdf_sampling;
  settings.roulette = method.roulette;
  return settings;
}

/// A renderer and how much of a study it has done.
struct Work {
  pathtracer::Renderer& renderer;
  const StudySettings& settings;
  const Progress& progress;
  double total = 0;  ///< samples per pixel of the whole study
  double done = 0;

  /// False when cancelled.
  bool render(const RenderSettings& render_settings, std::uint32_t samples) {
    renderer.restart(render_settings);
    const bool finished = renderer.render(
        samples, [&](double fraction) { return !progress || progress((done + fraction * samples) / total); });
    done += samples;
    return finished;
  }
};

std::optional<MethodResult> measure(Work& work, const Method& method, const std::vector<std::uint32_t>& counts,
                                    const Image& reference) {
  MethodResult result{.method = method, .measurements = {}};
  for (const std::uint32_t samples : counts) {
    if (!work.render(render_settings(method, work.settings, samples), samples)) return std::nullopt;
    result.measurements.push_back({.samples = samples,
                                   .rmse = compare::measure(reference, work.renderer.image()).rmse,
                                   .seconds = work.renderer.device_milliseconds() / 1000});
  }
  return result;
}

double sum(const std::vector<std::uint32_t>& counts) {
  double total = 0;
  for (const std::uint32_t count : counts) total += count;
  return total;
}

}  // namespace

std::vector<Method> methods() {
  std::vector<Method> result = {
      {.name = "independent"},
      {.name = "stratified", .sampler = SamplerKind::stratified},
      {.name = "Halton", .sampler = SamplerKind::halton},
      {.name = "Hammersley", .sampler = SamplerKind::hammersley},
      {.name = "Sobol", .sampler = SamplerKind::sobol},
      {.name = "blue noise", .sampler = SamplerKind::blue_noise},
      {.name = "MIS: balance heuristic", .mis = Mis::balance},
      {.name = "MIS: none", .mis = Mis::none},
      {.name = "no roulette", .roulette = false},
      {.name = "lights, cosine", .bsdf_sampling = BsdfSampling::cosine},
      {.name = "lights, uniform", .bsdf_sampling = BsdfSampling::uniform},
      {.name = "no lights, BSDF", .light_sampling = false},
      {.name = "no lights, cosine", .light_sampling = false, .bsdf_sampling = BsdfSampling::cosine},
      {.name = "no lights, uniform", .light_sampling = false, .bsdf_sampling = BsdfSampling::uniform}};
  return result;
}

Method thesis_method() {
  return {
      .name = "the thesis's method", .light_sampling = false, .bsdf_sampling = BsdfSampling::cosine, .roulette = false};
}

Method best_method() { return {.name = "lights, MIS, Sobol", .sampler = SamplerKind::sobol}; }

double MethodResult::slope() const {
  std::vector<double> counts, errors;
  for (const Measurement& measurement : measurements) {
    counts.push_back(measurement.samples);
    errors.push_back(measurement.rmse);
  }
  return convergence(counts, errors).slope;
}

double MethodResult::variance() const {
  const Measurement& last = measurements.back();
  return last.rmse * last.rmse * last.samples;
}

double MethodResult::efficiency() const {
  const Measurement& last = measurements.back();
  return 1 / (last.rmse * last.rmse * last.seconds);
}

std::optional<double> SampleRatio::ratio() const {
  const Measurement& target = thesis.measurements.back();
  const std::vector<Measurement>& steps = best.measurements;
  if (steps.front().rmse <= target.rmse) return target.samples / static_cast<double>(steps.front().samples);
  for (std::size_t i = 1; i < steps.size(); ++i) {
    if (steps[i].rmse > target.rmse) continue;
    const double part = std::log(target.rmse / steps[i - 1].rmse) / std::log(steps[i].rmse / steps[i - 1].rmse);
    const double growth = std::pow(static_cast<double>(steps[i].samples) / steps[i - 1].samples, part);
    return target.samples / (steps[i - 1].samples * growth);
  }
  return std::nullopt;
}

std::optional<SceneResult> study_scene(const rhi::DeviceHandle& device, const pathtracer::Scene& scene,
                                       const std::vector<Method>& methods, const StudySettings& settings,
                                       bool compares_thesis, const Progress& progress) {
  Method reference_method = best_method();
  RenderSettings reference_settings = render_settings(reference_method, settings, settings.reference_samples);
  reference_settings.seed = reference_seed;
  pathtracer::Renderer renderer(device, scene, reference_settings);
  // The thesis's method gets four times as many samples as the others have at most, since it needs them.
  std::vector<std::uint32_t> thesis_counts = settings.sample_counts;
  thesis_counts.push_back(4 * thesis_counts.back());
  std::vector<std::uint32_t> best_counts = {1};
  while (best_counts.back() < settings.sample_counts.back()) best_counts.push_back(2 * best_counts.back());

  Work work{.renderer = renderer, .settings = settings, .progress = progress};
  work.total = settings.reference_samples + static_cast<double>(methods.size()) * sum(settings.sample_counts);
  if (compares_thesis) work.total += sum(thesis_counts) + sum(best_counts);
  if (!work.render(reference_settings, settings.reference_samples)) return std::nullopt;
  const Image reference = renderer.image();

  SceneResult result{.scene = scene.name, .methods = {}, .sample_ratio = {}};
  for (const Method& method : methods) {
    std::optional<MethodResult> measured = measure(work, method, settings.sample_counts, reference);
    if (!measured) return std::nullopt;
    result.methods.push_back(std::move(*measured));
  }
  if (compares_thesis) {
    std::optional<MethodResult> thesis = measure(work, thesis_method(), thesis_counts, reference);
    if (!thesis) return std::nullopt;
    std::optional<MethodResult> best = measure(work, best_method(), best_counts, reference);
    if (!best) return std::nullopt;
    result.sample_ratio = {.thesis = std::move(*thesis), .best = std::move(*best)};
  }
  return result;
}

}  // namespace tandem::study
