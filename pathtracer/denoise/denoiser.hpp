#pragma once

#include <cstdint>

#include "pathtracer/denoise/noisy_picture.hpp"
#include "pathtracer/image/image.hpp"
#include "rhi/device.hpp"

namespace tandem::pathtracer {

struct DenoiseSettings {
  std::uint32_t levels = 5;        ///< 0 to 10: the last one looks 2^levels pixels far
  float luminance_deviations = 3;  ///< differences of luminance that count as noise, in standard errors; above 0
  float depth_slopes = 1;          ///< differences of depth that count as one surface, in its slope; above 0
  float albedo_difference = 0.3f;  ///< that counts as one material; above 0
  /// A pixel is a firefly this many standard deviations above the mean of the 48 pixels around it; 0: no pixel is.
  float firefly_deviations = 2;
};

/// Throws Error for numbers out of range.
void check(const DenoiseSettings& settings);

/// Takes noise out of pictures on a device, with the same bits on every device: an edge-avoiding a-trous wavelet
/// filter (Dammertz et al. 2010) guided by albedo, normal, depth and the variance of the samples (Schied et al. 2017,
/// Spatiotemporal Variance-Guided Filtering). What is filtered is radiance over albedo, so textures stay.
///
/// Fireflies are pulled down before the filter can spread them: to the mean of their neighbourhood plus
/// `firefly_deviations`, but by no more than the pixel's own standard error, so a highlight that every sample sees
/// stays. That takes light away: the result is biased, as every denoised picture is. A pixel that is no finite number
/// is filled in from its neighbours.
class Denoiser {
 public:
  /// Makes the programs. Throws rhi::Error.
  explicit Denoiser(rhi::DeviceHandle device);

  /// Throws Error for settings out of range or planes that differ in size, rhi::Error for what the device refuses.
  Image denoise(const NoisyPicture& picture, const DenoiseSettings& settings = {});

 private:
  rhi::DeviceHandle device_;
  rhi::ComputePipelineHandle prepare_, filter_, finish_;
};

}  // namespace tandem::pathtracer
