#pragma once

#include <cstdint>
#include <vector>

#include "pathtracer/render/renderer.hpp"
#include "rhi/device.hpp"

namespace tandem::test {

/// The forms of tracing that the device has; at least one.
std::vector<pathtracer::TracingMode> tracing_modes(const rhi::Device& device);

pathtracer::Image rendered(const rhi::DeviceHandle& device, const pathtracer::Scene& scene,
                           const pathtracer::RenderSettings& settings, std::uint32_t samples,
                           std::optional<pathtracer::TracingMode> trace = {});

/// Mean of the red channel over all pixels, and its standard error from the spread of the pixels, which have to be
/// independent estimates of the same value.
struct Estimate {
  double mean = 0;
  double standard_error = 0;
};
Estimate estimate(const pathtracer::Image& image);

}  // namespace tandem::test
