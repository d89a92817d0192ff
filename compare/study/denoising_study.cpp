#include "compare/study/denoising_study.hpp"

#include <chrono>

#include "compare/image/flip/flip.hpp"
#include "compare/metrics/metrics.hpp"
#include "pathtracer/render/renderer.hpp"

namespace tandem::study {
namespace {

// That of the reference is another, so that no picture shares its random numbers.
constexpr std::uint32_t seed = 1;
constexpr std::uint32_t reference_seed = 0x7e1a;

}  // namespace

PictureError picture_error(const pathtracer::Image& reference, const pathtracer::Image& picture) {
  const compare::Metrics metrics = compare::measure(reference, picture);
  return {.rmse = metrics.rmse,
          .flip = compare::flip(reference, picture).mean,
          .hdr_flip = compare::hdr_flip(reference, picture).errors.mean,
          .mean = metrics.mean_a > 0 ? metrics.mean_b / metrics.mean_a : 1};
}

std::optional<DenoisedScene> study_denoising(const rhi::DeviceHandle& device, const pathtracer::Scene& scene,
                                             const DenoisingSettings& study, const Progress& progress) {
  pathtracer::RenderSettings settings = pathtracer::render_settings(scene.settings);
  settings.width = settings.height = study.size;
  settings.planned_samples = study.samples;
  settings.seed = seed;
  pathtracer::Renderer renderer(device, scene, settings);
  const double total = double(study.samples) + study.reference_samples;
  const auto part = [&](double first, double count) {
    return [&progress, total, first, count](double fraction) {
      return !progress || progress((first + fraction * count) / total);
    };
  };
  const std::optional<pathtracer::NoisyPicture> noisy =
      pathtracer::render_noisy_picture(renderer, study.samples, part(0, study.samples));
  if (!noisy) return std::nullopt;
  DenoisedScene result;
  result.scene = scene.name;
  result.render_milliseconds = renderer.device_milliseconds();
  pathtracer::Denoiser denoiser(device);
  denoiser.denoise(*noisy, study.denoise);  // some drivers compile when a program first runs
  const auto start = std::chrono::steady_clock::now();
  const pathtracer::Image denoised = denoiser.denoise(*noisy, study.denoise);
  result.denoise_milliseconds =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  pathtracer::DenoiseSettings keeps_fireflies = study.denoise;
  keeps_fireflies.firefly_deviations = 0;
  const pathtracer::Image with_fireflies = denoiser.denoise(*noisy, keeps_fireflies);

  settings.seed = reference_seed;
  settings.planned_samples = study.reference_samples;
  renderer.restart(settings);
  if (!renderer.render(study.reference_samples, part(study.samples, study.reference_samples))) return std::nullopt;
  const pathtracer::Image reference = renderer.image();
  result.noisy = picture_error(reference, noisy->radiance);
  result.denoised = picture_error(reference, denoised);
  result.with_fireflies = picture_error(reference, with_fireflies);
  return result;
}

}  // namespace tandem::study
