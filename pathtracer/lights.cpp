#include "pathtracer/lights.hpp"

#include <cmath>
#include <cstddef>
#include <numeric>

namespace tandem::pathtracer {
namespace {

constexpr double threshold_scale = 4294967296.0;  // 2^32: the draws of 32 random bits

}  // namespace

double luminance(glm::vec3 rgb) { return 0.2126 * double{rgb.x} + 0.7152 * double{rgb.y} + 0.0722 * double{rgb.z}; }

std::vector<double> light_probabilities(const std::vector<GpuLight>& lights) {
  std::vector<double> probabilities(lights.size(), 0.0);
  for (std::size_t i = 0; i < lights.size(); ++i) {
    const double keep = lights[i].alias == i ? 1.0 : double(lights[i].threshold) / threshold_scale;
    probabilities[i] += keep / double(lights.size());
    probabilities[lights[i].alias] += (1 - keep) / double(lights.size());
  }
  return probabilities;
}

std::vector<GpuLight> build_lights(const Scene& scene) {
  std::vector<GpuLight> lights;
  std::vector<double> areas;
  std::vector<double> weights;
  for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
    const GpuTriangle& triangle = scene.triangles[i];
    const double power = luminance(scene.materials[triangle.material & ~triangle_smooth].emission);
    const double area = power > 0 ? triangle_area(scene, triangle) : 0;
    if (!(area * power > 0)) continue;
    lights.push_back({.primitive = static_cast<std::uint32_t>(i)});
    areas.push_back(area);
    weights.push_back(area * power);
  }

  // Vose: entries below the average are filled up by one entry above it.
  const double average = std::accumulate(weights.begin(), weights.end(), 0.0) / double(weights.size());
  std::vector<std::uint32_t> small, large;
  for (std::uint32_t i = 0; i < lights.size(); ++i) {
    weights[i] /= average;
    (weights[i] < 1 ? small : large).push_back(i);
  }
  while (!small.empty() && !large.empty()) {
    const std::uint32_t under = small.back();
    const std::uint32_t over = large.back();
    small.pop_back();
    lights[under].alias = over;
    lights[under].threshold = static_cast<std::uint32_t>(weights[under] * threshold_scale);
    weights[over] -= 1 - weights[under];
    if (weights[over] < 1) {
      large.pop_back();
      small.push_back(over);
    }
  }
  // What is left is full, or missed it by rounding: alias to itself, so that the threshold no longer matters.
  for (const std::vector<std::uint32_t>& rest : {small, large})
    for (const std::uint32_t i : rest) {
      lights[i].alias = i;
      lights[i].threshold = ~std::uint32_t{0};
    }

  const std::vector<double> probabilities = light_probabilities(lights);
  for (std::size_t i = 0; i < lights.size(); ++i) {
    lights[i].area_density = static_cast<float>(probabilities[i] / areas[i]);
    lights[i].probability = static_cast<float>(probabilities[i]);
  }
  return lights;
}

}  // namespace tandem::pathtracer
