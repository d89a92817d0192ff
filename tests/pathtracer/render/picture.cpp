#include "tests/pathtracer/render/picture.hpp"

#include <cmath>

#include <doctest/doctest.h>

namespace tandem::test {

using pathtracer::TraceForm;

rhi::DeviceHandle handle(rhi::Device& device) { return {std::shared_ptr<void>(), &device}; }

std::vector<TraceForm> trace_forms(const rhi::Device& device) {
  std::vector<TraceForm> forms;
  if (device.info().capabilities.ray_query) forms.push_back(TraceForm::query);
  if (device.info().capabilities.ray_tracing_pipeline) forms.push_back(TraceForm::pipeline);
  REQUIRE_FALSE(forms.empty());
  return forms;
}

pathtracer::Image rendered(rhi::Device& device, const pathtracer::Scene& scene,
                           const pathtracer::RenderSettings& settings, std::uint32_t samples,
                           std::optional<TraceForm> trace) {
  pathtracer::Renderer renderer(handle(device), scene, settings, trace);
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
