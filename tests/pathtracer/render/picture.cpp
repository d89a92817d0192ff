#include "tests/pathtracer/render/picture.hpp"

#include <cmath>

#include <doctest/doctest.h>

namespace tandem::test {

using pathtracer::TracingMode;

std::vector<TracingMode> tracing_modes(const rhi::Device& device) {
  std::vector<TracingMode> forms;
  if (device.info().capabilities.ray_query) forms.push_back(TracingMode::query);
  if (device.info().capabilities.ray_tracing_pipeline) forms.push_back(TracingMode::pipeline);
  REQUIRE_FALSE(forms.empty());
  return forms;
}

pathtracer::Image rendered(const rhi::DeviceHandle& device, const pathtracer::Scene& scene,
                           const pathtracer::RenderSettings& settings, std::uint32_t samples,
                           std::optional<TracingMode> trace) {
  pathtracer::Renderer renderer(device, scene, settings, trace);
  REQUIRE(renderer.render(samples));
  return renderer.image();
}

Estimate estimate(const pathtracer::Image& image) {
  const auto count = double(image.pixels.size());
  double sum = 0, squares = 0;
  for (const glm::vec3& pixel : image.pixels) {
    sum += pixel.x;
    squares += double{pixel.x} * double{pixel.x};
  }
  const double mean = sum / count;
  return {mean, std::sqrt((squares / count - mean * mean) / (count - 1))};
}

}  // namespace tandem::test
