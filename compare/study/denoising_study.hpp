#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/progress.hpp"
#include "pathtracer/denoise/denoiser.hpp"
#include "pathtracer/scene/scene.hpp"
#include "rhi/device.hpp"

/// What the denoiser is worth: how far its picture is from one of many samples, and how far the noisy one is.
namespace tandem::study {

struct DenoisingSettings {
  std::uint32_t size = 128;  ///< pixels, each way
  std::uint32_t samples = 16;
  std::uint32_t reference_samples = 4096;
  pathtracer::DenoiseSettings denoise;
};

/// How far a picture is from the reference.
struct PictureError {
  double rmse = 0;      ///< over pixels and channels
  double flip = 0;      ///< mean of compare::flip
  double hdr_flip = 0;  ///< mean of compare::hdr_flip
  double mean = 0;      ///< mean radiance over that of the reference
};

struct DenoisedScene {
  std::string scene;
  PictureError noisy;
  PictureError denoised;            ///< denoised, fireflies pulled down as the settings say
  PictureError with_fireflies;      ///< denoised without pulling any down
  double render_milliseconds = 0;   ///< of the noisy picture, on the device
  double denoise_milliseconds = 0;  ///< by the host's clock
};

/// The error of a picture. Throws as compare::measure.
PictureError picture_error(const pathtracer::Image& reference, const pathtracer::Image& picture);

/// Renders the scene twice, with different random numbers, and denoises the picture of few samples. The scene's own
/// settings count; the size is the study's.
/// @return nothing when `progress` cancelled. Throws what Renderer throws.
std::optional<DenoisedScene> study_denoising(const rhi::DeviceHandle& device, const pathtracer::Scene& scene,
                                             const DenoisingSettings& settings, const Progress& progress = {});

}  // namespace tandem::study
