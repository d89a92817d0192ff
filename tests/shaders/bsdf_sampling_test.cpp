#include <doctest/doctest.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "tests/shaders/bsdf_materials.hpp"
#include "tests/shaders/random_source.hpp"
#include "tests/support/device_test.hpp"
#include "tests/support/statistics/chi_square.hpp"

using namespace tandem;

namespace {

constexpr double incidence[] = {0.95, 0.55, 0.2};

constexpr test::SphereBins sphere = {.rows = 24, .columns = 24};
constexpr std::size_t points = 8;  // of each bin, in each direction

std::uint32_t bits_of(double value) { return std::bit_cast<std::uint32_t>(static_cast<float>(value)); }
float float_of(std::uint32_t bits) { return std::bit_cast<float>(bits); }

void append(std::vector<std::uint32_t>& rows, glm::vec3 v) {
  rows.insert(rows.end(), {bits_of(v.x), bits_of(v.y), bits_of(v.z)});
}

/// What bsdf_value says of one bin.
struct Bin {
  double probability = 0;  ///< integral of the density
  double albedo = 0;       ///< integral of the green channel times the cosine
};

/// Bins for every material and incidence, in that order. The azimuth of wo is 0.
std::vector<Bin> integrate(rhi::Device& device, const std::vector<test::BsdfMaterial>& materials) {
  std::vector<std::uint32_t> rows;
  for (std::uint32_t material = 0; material < materials.size(); ++material)
    for (const double cosine : incidence)
      for (std::uint32_t bin = 0; bin < sphere.count(); ++bin) {
        rows.push_back(material);
        append(rows, test::direction_at(cosine, 0));
        rows.push_back(bin);
      }
  const test::FunctionKernel kernel = test::bsdf_kernel(materials, R"(
    BsdfParameters p = material(input_bits(0));
    vec3 wo = vec3(input_float(1), input_float(2), input_float(3));
    float density = 0.0, albedo = 0.0;
    for (uint y = 0; y < 8; ++y)
      for (uint x = 0; x < 8; ++x) {
        float z = 2.0 * (float(8 * (input_bits(4) / 24) + y) + 0.5) / 192.0 - 1.0;
        float turn = 2.0 * PI * (float(8 * (input_bits(4) % 24) + x) + 0.5) / 192.0;
        float sine = sqrt((1.0 - z) * (1.0 + z));
        BsdfValue v = bsdf_value(p, wo, vec3(sine * cos(turn), sine * sin(turn), z));
        density += v.density;
        albedo += v.value.y * abs(z);
      }
    output_float(0, density);
    output_float(1, albedo);)",
                                                        5, 2);
  static_assert(sphere.rows == 24 && sphere.columns == 24 && points == 8);
  const std::vector<std::uint32_t> outputs = test::run_bits(device, kernel, rows);
  std::vector<Bin> bins;
  const double solid_angle = sphere.solid_angle() / (points * points);
  for (std::size_t i = 0; i < outputs.size(); i += 2)
    bins.push_back({float_of(outputs[i]) * solid_angle, float_of(outputs[i + 1]) * solid_angle});
  return bins;
}

struct Sample {
  glm::vec3 direction, weight;
  float density;
  std::uint32_t lobe;
  float eta;
  glm::vec3 value;  ///< of bsdf_value at the direction
  float evaluated_density;
};

constexpr std::uint32_t sample_count = 4096;

/// Samples of every material and incidence, in that order.
std::vector<Sample> draw(rhi::Device& device, const std::vector<test::BsdfMaterial>& materials,
                         const std::vector<double>& cosines) {
  test::RandomSource random(3);
  std::vector<std::uint32_t> rows;
  for (std::uint32_t material = 0; material < materials.size(); ++material)
    for (const double cosine : cosines)
      for (std::uint32_t i = 0; i < sample_count; ++i) {
        rows.push_back(material);
        append(rows, test::direction_at(cosine, 0));
        for (int k = 0; k < 3; ++k) rows.push_back(bits_of((random.bits() >> 8) * 0x1p-24));
      }
  const test::FunctionKernel kernel = test::bsdf_kernel(materials, R"(
    BsdfParameters p = material(input_bits(0));
    vec3 wo = vec3(input_float(1), input_float(2), input_float(3));
    BsdfSample s = bsdf_sample(p, wo, vec3(input_float(4), input_float(5), input_float(6)));
    output_float(0, s.direction.x); output_float(1, s.direction.y); output_float(2, s.direction.z);
    output_float(3, s.weight.x); output_float(4, s.weight.y); output_float(5, s.weight.z);
    output_float(6, s.density);
    output_bits(7, s.lobe);
    output_float(8, s.eta);
    BsdfValue v = bsdf_value(p, wo, s.direction);
    output_float(9, v.value.x); output_float(10, v.value.y); output_float(11, v.value.z);
    output_float(12, v.density);)",
                                                        7, 13);
  const std::vector<std::uint32_t> out = test::run_bits(device, kernel, rows);
  std::vector<Sample> samples;
  for (std::size_t i = 0; i < out.size(); i += 13) {
    const auto vector = [&](std::size_t k) {
      return glm::vec3(float_of(out[i + k]), float_of(out[i + k + 1]), float_of(out[i + k + 2]));
    };
    samples.push_back({vector(0), vector(3), float_of(out[i + 6]), out[i + 7], float_of(out[i + 8]), vector(9),
                       float_of(out[i + 12])});
  }
  return samples;
}

constexpr std::uint32_t diffuse_lobe = 1, specular_lobe = 2, transmission_lobe = 4, glossy_lobe = 8;

}  // namespace

TANDEM_DEVICE_TEST("Every BSDF is sampled with its density, and both give the same albedo") {
  const std::vector<test::BsdfMaterial> materials = test::wide_materials();
  const std::vector<Bin> bins = integrate(device, materials);
  const std::vector<Sample> samples =
      draw(device, materials, std::vector<double>(std::begin(incidence), std::end(incidence)));
  constexpr std::size_t bin_count = 24 * 24;
  for (std::size_t job = 0; job < materials.size() * std::size(incidence); ++job) {
    INFO(materials[job / std::size(incidence)].name, ", cosine ", incidence[job % std::size(incidence)]);
    std::vector<double> counts(bin_count + 1), expected(bin_count + 1);
    double total = 0, albedo = 0, sampled = 0, sampled_square = 0;
    for (std::size_t i = 0; i < bin_count; ++i) {
      const Bin& bin = bins[job * bin_count + i];
      // The midpoint rule says 0 rather than the little that is left at the edge of a lobe.
      expected[i] = std::max(bin.probability * sample_count, 1e-3);
      total += bin.probability;
      albedo += bin.albedo;
    }
    expected[bin_count] = std::max((1.0 - total) * sample_count, 1e-3);
    for (std::size_t i = 0; i < sample_count; ++i) {
      const Sample& sample = samples[job * sample_count + i];
      counts[sample.lobe == 0 ? bin_count : sphere.bin(glm::dvec3(sample.direction))] += 1;
      sampled += sample.weight.y;
      sampled_square += double{sample.weight.y} * sample.weight.y;
    }
    const double lost = counts[bin_count] / sample_count;
    const double mean = sampled / sample_count;
    const double error = std::sqrt(std::max(sampled_square / sample_count - mean * mean, 0.0) / sample_count);
    // Five standard deviations and a p-value of 1e-6: with 225 checks one seed in 4000 would fail by chance. The
    // midpoint rule adds up to 0.005, measured, where a lobe is cut off by the horizon or narrower than ten points.
    CHECK(std::abs(total + lost - 1.0) < 5.0 * std::sqrt(lost * (1.0 - lost) / sample_count) + 0.005);
    CHECK(std::abs(albedo - mean) < 5.0 * error + 0.005);
    CHECK(test::chi_square(counts, expected).p_value > 1e-6);
  }
}

TANDEM_DEVICE_TEST("A BSDF sample's weight is value * cosine / density, and its lobe says where it is") {
  std::vector<test::BsdfMaterial> materials = test::wide_materials();
  const std::vector<test::BsdfMaterial> extreme = test::extreme_materials();
  materials.insert(materials.end(), extreme.begin(), extreme.end());
  const std::vector<double> cosines = {1, 0.7, 0.02};
  const std::vector<Sample> samples = draw(device, materials, cosines);
  std::uint32_t lobes_seen = 0;
  double worst_weight = 0, worst_length = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const test::BsdfMaterial& material = materials[i / sample_count / cosines.size()];
    const Sample& s = samples[i];
    if (s.lobe == 0) {
      if (s.weight != glm::vec3(0)) FAIL_CHECK(material.name, ": nothing scattered has a weight");
      continue;
    }
    lobes_seen |= s.lobe;
    const bool below = (s.lobe & transmission_lobe) != 0;
    if ((s.lobe & specular_lobe) != 0 || below != (s.direction.z < 0)) FAIL_CHECK(material.name, ": lobe ", s.lobe);
    if (below != (s.eta != 1.0f) && material.parameters.model == pathtracer::MaterialModel::rough_dielectric)
      FAIL_CHECK(material.name, ": eta ", s.eta);
    worst_length = std::max(worst_length, std::abs(std::hypot(s.direction.x, s.direction.y, s.direction.z) - 1.0));
    if (s.density != s.evaluated_density) FAIL_CHECK(material.name, ": ", s.density, " != ", s.evaluated_density);
    for (int channel = 0; channel < 3; ++channel) {
      const double expected = double{s.value[channel]} * std::abs(s.direction.z) / s.density;
      if (!(s.weight[channel] >= 0)) FAIL_CHECK(material.name, ": weight ", s.weight[channel]);
      worst_weight = std::max(worst_weight, std::abs(s.weight[channel] - expected) / std::max(expected, 0.01));
    }
  }
  CHECK(lobes_seen == (diffuse_lobe | glossy_lobe | transmission_lobe));
  CHECK(worst_weight < 1e-6);  // a few roundings
  CHECK(worst_length < 5e-7);
}

TEST_CASE("BSDF samples are the same bits on all devices") {
  const test::NoWarnings no_warnings;
  std::vector<test::BsdfMaterial> materials = test::wide_materials();
  for (const auto& list : {test::extreme_materials(), test::specular_materials()})
    materials.insert(materials.end(), list.begin(), list.end());
  const std::vector<double> cosines = {0.9, 0.3};
  using Words = std::array<std::uint32_t, sizeof(Sample) / sizeof(std::uint32_t)>;
  std::vector<Sample> first;
  for (const std::string& name : test::device_names()) {
    const std::vector<Sample> samples = draw(*test::device(name), materials, cosines);
    if (first.empty()) first = samples;
    std::size_t different = 0;
    for (std::size_t i = 0; i < samples.size(); ++i)
      different += std::bit_cast<Words>(samples[i]) != std::bit_cast<Words>(first[i]);
    INFO(name, " and ", test::device_names().front(), " of ", samples.size());
    CHECK(different == 0);
  }
}
