#include "tests/shaders/light_samples.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include <glm/geometric.hpp>

#include "tests/shaders/random_source.hpp"
#include "tests/shaders/scene_kernel.hpp"

namespace tandem::test {

std::vector<LightSample> light_samples(rhi::Device& device, const pathtracer::Scene& scene, const glm::vec3& position,
                                       std::size_t count, float time, std::uint32_t primitive) {
  const FunctionKernel kernel = {.includes = "#include \"light/light.glsl\"",
                                 .body = R"(
    vec3 position = vec3(input_float(4), input_float(5), input_float(6));
    LightSample light = sample_light(position, uvec4(input_bits(0), input_bits(1), input_bits(2), input_bits(3)),
                                     input_float(7));
    output_float(0, light.direction.x); output_float(1, light.direction.y); output_float(2, light.direction.z);
    output_float(3, light.radiance.x); output_float(4, light.radiance.y); output_float(5, light.radiance.z);
    output_float(6, light.density);
    output_float(7, light.target.x); output_float(8, light.target.y); output_float(9, light.target.z);
    output_float(10, light.target_normal.x); output_float(11, light.target_normal.y);
    output_float(12, light.target_normal.z);
    output_float(13, light.target_offset);
    output_bits(14, light.primitive);
    output_bits(15, light.infinite ? 1u : 0u);
    uint primitive = light.primitive == NO_PRIMITIVE ? input_bits(8) : light.primitive;
    output_float(16, light.density == 0.0 ? 0.0
                     : light.infinite     ? environment_density(light.direction)
                                          : light_density(primitive, position, light.direction, light.target,
                                                          light.target_normal, input_float(7)));)",
                                 .input_count = 9,
                                 .output_count = 17};
  RandomSource random(23);
  std::vector<std::uint32_t> inputs;
  for (std::size_t i = 0; i < count; ++i) {
    for (int k = 0; k < 4; ++k) inputs.push_back(random.bits());
    for (const float value : {position.x, position.y, position.z, time})
      inputs.push_back(std::bit_cast<std::uint32_t>(value));
    inputs.push_back(primitive);
  }
  const std::vector<std::uint32_t> bits = run_bits(device, scene, kernel, inputs);
  std::vector<LightSample> samples;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t* row = bits.data() + i * kernel.output_count;
    const auto number = [&](std::size_t k) { return std::bit_cast<float>(row[k]); };
    const auto vector = [&](std::size_t k) { return glm::vec3(number(k), number(k + 1), number(k + 2)); };
    samples.push_back({.direction = vector(0),
                       .radiance = vector(3),
                       .density = number(6),
                       .target = vector(7),
                       .target_normal = vector(10),
                       .target_offset = number(13),
                       .primitive = row[14],
                       .infinite = row[15] != 0,
                       .scattering_density = number(16)});
  }
  return samples;
}

std::vector<double> irradiances(const std::vector<LightSample>& samples, const glm::dvec3& normal) {
  std::vector<double> values;
  for (const LightSample& sample : samples) {
    const double cosine = std::max(glm::dot(glm::dvec3(sample.direction), normal), 0.0);
    values.push_back(double{sample.radiance.x} * cosine / (sample.density > 0 ? double{sample.density} : 1.0));
  }
  return values;
}

}  // namespace tandem::test
