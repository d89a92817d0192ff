#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "pathtracer/scene/scene.hpp"
#include "rhi/device.hpp"

namespace tandem::test {

/// What sample_light gives, and the density that a path which finds the same point by scattering asks for.
struct LightSample {
  glm::vec3 direction;
  glm::vec3 radiance;
  float density;
  glm::vec3 target;
  glm::vec3 target_normal;
  float target_offset;
  std::uint32_t primitive;  ///< the triangle
  bool infinite;
  float scattering_density;  ///< light_density of `primitive`, or environment_density
};

/// sample_light at a point, `count` times with independent bits. @param primitive of the sphere, for the density of the
/// points on one; ignored for triangles and the environment
std::vector<LightSample> light_samples(rhi::Device& device, const pathtracer::Scene& scene, const glm::vec3& position,
                                       std::size_t count, float time = 0, std::uint32_t primitive = 0);

/// Irradiance of a surface element that nothing shades, sample by sample.
std::vector<double> irradiances(const std::vector<LightSample>& samples, const glm::dvec3& normal);

}  // namespace tandem::test
