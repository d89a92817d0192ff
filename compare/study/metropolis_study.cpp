#include "compare/study/metropolis_study.hpp"

#include <cmath>
#include <utility>

#include <glm/geometric.hpp>

#include "compare/statistics/batched_estimate.hpp"
#include "compare/statistics/bias_test.hpp"

namespace tandem::study {
namespace {

using pathtracer::Image;
using pathtracer::Integrator;
using pathtracer::RenderSettings;

/// Of the bias test. Smaller ones are not nearly normal.
constexpr std::uint32_t tile = 16;

/// The root of the mean variance of a channel of a pixel.
double spread(const std::vector<Image>& pictures) {
  double sum = 0;
  const std::size_t pixels = pictures.front().pixels.size();
  for (std::size_t i = 0; i < pixels; ++i) {
    glm::dvec3 mean(0);
    for (const Image& picture : pictures) mean += glm::dvec3(picture.pixels[i]) / double(pictures.size());
    for (const Image& picture : pictures) {
      const glm::dvec3 deviation = glm::dvec3(picture.pixels[i]) - mean;
      sum += glm::dot(deviation, deviation);
    }
  }
  return std::sqrt(sum / (3 * double(pixels) * double(pictures.size() - 1)));
}

/// A renderer and how much of a study it has done.
struct Work {
  pathtracer::Renderer& renderer;
  const Progress& progress;
  double total = 0;  ///< samples per pixel of the whole study
  double done = 0;

  /// False when cancelled.
  bool render(const RenderSettings& settings, std::uint32_t samples) {
    renderer.restart(settings);
    renderer.warm_up();
    const bool finished = renderer.render(
        samples, [&](double fraction) { return !progress || progress((done + fraction * samples) / total); });
    done += samples;
    return finished;
  }

  /// Pictures under different seeds; nothing when cancelled.
  std::optional<std::vector<Image>> render_all(RenderSettings settings, std::uint32_t samples, std::uint32_t count,
                                               Measurement& measurement) {
    std::vector<Image> pictures;
    measurement.samples = samples;
    for (std::uint32_t i = 0; i < count; ++i) {
      if (!render(settings, samples)) return std::nullopt;
      pictures.push_back(renderer.image());
      measurement.seconds += renderer.device_milliseconds() / 1000 / count;
      ++settings.seed;
    }
    measurement.rmse = spread(pictures);
    return pictures;
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
  for (const std::uint32_t count : settings.sample_counts) work.total += 2 * double(count) * settings.pictures;
  MetropolisResult result;
  for (const std::uint32_t samples : settings.sample_counts) {
    // Turn by turn, so that whatever else the machine does slows both.
    RenderSettings method = usual;
    method.integrator = Integrator::path;
    Measurement of_path, of_metropolis;
    std::optional<std::vector<Image>> paths = work.render_all(method, samples, settings.pictures, of_path);
    if (!paths) return std::nullopt;
    method.integrator = Integrator::metropolis;
    const std::optional<std::vector<Image>> chains = work.render_all(method, samples, settings.pictures, of_metropolis);
    if (!chains) return std::nullopt;
    result.path.measurements.push_back(of_path);
    result.metropolis.measurements.push_back(of_metropolis);
    result.bias_p_value = compare::test_bias(compare::batched(*chains, tile), compare::batched(*paths, tile)).p_value;
  }
  return result;
}

}  // namespace tandem::study
