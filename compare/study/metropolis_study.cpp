#include "compare/study/metropolis_study.hpp"

#include <cmath>
#include <utility>

#include "compare/metrics/metrics.hpp"

namespace tandem::study {
namespace {

using pathtracer::Integrator;
using pathtracer::RenderSettings;

// That of the reference is another, so that no picture shares its random numbers.
constexpr std::uint32_t reference_seed = 0x7e1a;

/// A renderer and how much of a study it has done.
struct Work {
  pathtracer::Renderer& renderer;
  const Progress& progress;
  double total = 0;  ///< samples per pixel of the whole study
  double done = 0;

  /// False when cancelled.
  bool render(RenderSettings settings, Integrator integrator, std::uint32_t seed, std::uint32_t samples) {
    settings.integrator = integrator;
    settings.seed = seed;
    renderer.restart(settings);
    const bool finished = renderer.render(
        samples, [&](double fraction) { return !progress || progress((done + fraction * samples) / total); });
    done += samples;
    return finished;
  }
};

}  // namespace

double IntegratorResult::error_after(double seconds) const {
  const Measurement& last = measurements.back();
  return last.rmse * std::sqrt(last.seconds / seconds);
}

double MetropolisResult::error_ratio() const {
  const Measurement& last = metropolis.measurements.back();
  return path.error_after(last.seconds) / last.rmse;
}

std::optional<MetropolisResult> study_metropolis(pathtracer::Renderer& renderer,
                                                 const MetropolisStudySettings& settings, const Progress& progress) {
  const RenderSettings usual = renderer.scene().settings();
  Work work{.renderer = renderer, .progress = progress};
  work.total = settings.reference_samples;
  for (const std::uint32_t count : settings.sample_counts) work.total += 2 * double(count);
  if (!work.render(usual, Integrator::metropolis, reference_seed, settings.reference_samples)) return std::nullopt;
  const pathtracer::Image reference = renderer.image();
  MetropolisResult result;
  for (const Integrator integrator : {Integrator::path, Integrator::metropolis}) {
    IntegratorResult& measured = integrator == Integrator::path ? result.path : result.metropolis;
    for (const std::uint32_t samples : settings.sample_counts) {
      if (!work.render(usual, integrator, usual.seed, samples)) return std::nullopt;
      measured.measurements.push_back({.samples = samples,
                                       .rmse = compare::measure(reference, renderer.image()).rmse,
                                       .seconds = renderer.device_milliseconds() / 1000});
    }
  }
  return result;
}

}  // namespace tandem::study
