#include <doctest/doctest.h>

#include <bit>
#include <cmath>
#include <complex>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "tests/shaders/bsdf_materials.hpp"
#include "tests/shaders/random_source.hpp"
#include "tests/support/device_test.hpp"

using namespace tandem;

namespace {

std::uint32_t bits_of(double value) { return std::bit_cast<std::uint32_t>(static_cast<float>(value)); }
float float_of(std::uint32_t bits) { return std::bit_cast<float>(bits); }

void append(std::vector<std::uint32_t>& rows, glm::vec3 v) {
  rows.insert(rows.end(), {bits_of(v.x), bits_of(v.y), bits_of(v.z)});
}

/// The fraction of light that each material gives back, by channel, for each cosine in turn: the mean of the weights of
/// 32768 samples with the points of a low-discrepancy sequence, the factor 1 / eta^2 of refraction taken out.
std::vector<glm::dvec3> albedos(rhi::Device& device, const std::vector<test::BsdfMaterial>& materials,
                                const std::vector<double>& cosines) {
  constexpr std::uint32_t blocks = 32;
  std::vector<std::uint32_t> rows;
  for (std::uint32_t material = 0; material < materials.size(); ++material)
    for (const double cosine : cosines)
      for (std::uint32_t block = 0; block < blocks; ++block) {
        rows.push_back(material);
        append(rows, test::direction_at(cosine, 0.7));
        rows.push_back(block);
      }
  // Multiples of the powers of the plastic number's three-dimensional relative, in 32 bits (Roberts 2018).
  const test::FunctionKernel kernel = test::bsdf_kernel(materials, R"(
    BsdfParameters p = material(input_bits(0));
    vec3 wo = vec3(input_float(1), input_float(2), input_float(3));
    vec3 sum = vec3(0.0);
    for (uint i = 0; i < 1024; ++i) {
      uint n = input_bits(4) * 1024 + i;
      vec3 u = vec3((uvec3(n * 3518319155u, n * 2882110345u, n * 2360945575u) + 0x80000000u) >> 8) / 16777216.0;
      BsdfSample s = bsdf_sample(p, wo, u);
      sum += s.weight * s.eta * s.eta;
    }
    output_float(0, sum.x); output_float(1, sum.y); output_float(2, sum.z);)",
                                                        5, 3);
  const std::vector<std::uint32_t> outputs = test::run_bits(device, kernel, rows);
  std::vector<glm::dvec3> result(materials.size() * cosines.size());
  for (std::size_t i = 0; i < rows.size() / 5; ++i)
    for (int channel = 0; channel < 3; ++channel)
      result[i / blocks][channel] += float_of(outputs[3 * i + static_cast<std::size_t>(channel)]) / (blocks * 1024.0);
  return result;
}

const std::vector<double> cosine_grid = {1.0, 0.9, 0.7, 0.5, 0.3, 0.15, 0.05, 0.01};

/// A white material of every model for several roughnesses.
std::vector<test::BsdfMaterial> white_materials() {
  std::vector<test::BsdfMaterial> materials;
  const auto add = [&](const char* name, pathtracer::MaterialModel model, float roughness, auto change) {
    pathtracer::GpuMaterial m;
    m.model = model;
    m.base_color = m.reflectance = m.transmittance = glm::vec3(1);
    m.roughness = roughness;
    m.ior = 1.5f;
    change(m);
    materials.push_back({fmt::format("{} {:.1f}", name, roughness), m});
  };
  using enum pathtracer::MaterialModel;
  const auto same = [](pathtracer::GpuMaterial&) {};
  for (const float roughness : {0.0f, 0.2f, 0.4f, 0.6f, 0.8f, 1.0f}) {
    add("conductor", conductor, roughness, same);
    add("plastic", principled, roughness, same);
    add("metal", principled, roughness, [](pathtracer::GpuMaterial& m) { m.metallic = 1; });
    add("sheet", principled, roughness, [](pathtracer::GpuMaterial& m) { m.transmission = 1; });
    add("glass", rough_dielectric, roughness, same);
    add("glass inside", rough_dielectric, roughness, same);
    materials.back().outside = false;
    add("oren_nayar", oren_nayar, roughness, same);
  }
  add("lambert", diffuse, 0, same);
  return materials;
}

}  // namespace

TANDEM_DEVICE_TEST("No BSDF gives back more light than arrives, and white ones lose what is documented") {
  std::vector<test::BsdfMaterial> materials = white_materials();
  // By how much a white furnace gets darker at most (docs/shaders.md). Compensated models are off by the error of their
  // fit, in both directions; facets that refract lose what they pass among themselves, grooves what they do.
  std::map<std::string, std::pair<double, double>> bounds = {
      {"conductor", {0.01, 0.01}}, {"plastic", {0.01, 0.01}},      {"metal", {0.01, 0.01}},
      {"sheet", {0.70, 0.001}},    {"glass", {0.40, 0.001}},       {"glass inside", {0.60, 0.001}},
      {"oren_nayar", {0.5, 0.01}}, {"lambert", {0.00001, 0.00001}}};
  const std::size_t white_count = materials.size();
  for (const auto& list : {test::wide_materials(), test::extreme_materials(), test::specular_materials()})
    materials.insert(materials.end(), list.begin(), list.end());
  const std::vector<glm::dvec3> albedo = albedos(device, materials, cosine_grid);
  std::map<std::string, std::pair<double, double>> measured;
  for (std::size_t i = 0; i < materials.size(); ++i) {
    std::string line = materials[i].name + ":";
    for (std::size_t k = 0; k < cosine_grid.size(); ++k) {
      const glm::dvec3 a = albedo[i * cosine_grid.size() + k];
      INFO(materials[i].name, ", cosine ", cosine_grid[k]);
      line += fmt::format(" {:.4f}", a.x);
      if (i >= white_count) {
        for (int channel = 0; channel < 3; ++channel) CHECK(a[channel] < 1.01);
        continue;
      }
      const std::string kind = materials[i].name.substr(0, materials[i].name.rfind(' '));
      CHECK(a.x > 1.0 - bounds.at(kind).first);
      CHECK(a.x < 1.0 + bounds.at(kind).second);
    }
    MESSAGE(line);
  }
}
