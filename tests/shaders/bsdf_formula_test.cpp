#include <doctest/doctest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <vector>

#include <glm/geometric.hpp>

#include "tests/shaders/bsdf_materials.hpp"
#include "tests/shaders/random_source.hpp"
#include "tests/support/device_test.hpp"

using namespace tandem;

namespace {

using pathtracer::GpuMaterial;
using pathtracer::MaterialModel;

/// The BSDF of the red channel as the papers write it, in double precision.
using Formula = std::function<double(const GpuMaterial&, glm::dvec3 wo, glm::dvec3 wi)>;

double angle(double cosine) { return std::acos(std::clamp(cosine, -1.0, 1.0)); }

/// Oren and Nayar 1994, equation 30.
double oren_nayar(const GpuMaterial& m, glm::dvec3 wo, glm::dvec3 wi) {
  const double sigma2 = double{m.roughness} * m.roughness;
  const double a = 1.0 - 0.5 * sigma2 / (sigma2 + 0.33), b = 0.45 * sigma2 / (sigma2 + 0.09);
  const double theta_o = angle(wo.z), theta_i = angle(wi.z);
  const double azimuth = std::atan2(wo.y, wo.x) - std::atan2(wi.y, wi.x);
  const double sum = a + b * std::max(0.0, std::cos(azimuth)) * std::sin(std::max(theta_o, theta_i)) *
                             std::tan(std::min(theta_o, theta_i));
  // The one deviation from the paper: no more is given back than arrives.
  return m.base_color.x * std::numbers::inv_pi * sum / std::max(1.0, a + 0.5 * b);
}

/// Lafortune and Willems 1994, equation 3.
double phong(const GpuMaterial& m, glm::dvec3 wo, glm::dvec3 wi) {
  const glm::dvec3 mirrored(-wo.x, -wo.y, wo.z);
  return m.base_color.x * std::numbers::inv_pi + m.reflectance.x * (m.exponent + 2.0) / (2.0 * std::numbers::pi) *
                                                     std::pow(std::max(0.0, glm::dot(mirrored, wi)), m.exponent);
}

/// Walter et al. 2007: GGX by its angle (equation 33).
double ggx(double alpha, double cosine) {
  if (!(cosine > 0)) return 0;
  const double tangent2 = 1.0 / (cosine * cosine) - 1.0;
  return alpha * alpha / (std::numbers::pi * std::pow(cosine, 4) * std::pow(alpha * alpha + tangent2, 2));
}

/// Heitz 2014: Smith's Lambda of GGX (equation 72).
double smith_lambda(double alpha, double cosine) {
  const double tangent2 = 1.0 / (cosine * cosine) - 1.0;
  return 0.5 * (std::sqrt(1.0 + alpha * alpha * tangent2) - 1.0);
}

/// Fresnel's equations as Walter et al. give them (equation 22), c = |i m|.
double walter_fresnel(double c, double eta) {
  const double g2 = eta * eta - 1.0 + c * c;
  if (g2 <= 0) return 1.0;
  const double g = std::sqrt(g2);
  const double first = (g - c) / (g + c), second = (c * (g + c) - 1.0) / (c * (g - c) + 1.0);
  return 0.5 * first * first * (1.0 + second * second);
}

/// Walter et al. 2007, equations 20 and 21, with shadowing of correlated heights, for light from wi, scattered to wo.
double rough_dielectric(const GpuMaterial& m, glm::dvec3 wo, glm::dvec3 wi) {
  const double alpha = double{m.roughness} * m.roughness;
  const double index_o = 1.0, index_i = wi.z > 0 ? 1.0 : m.ior;
  const double g = 1.0 / (1.0 + smith_lambda(alpha, wo.z) + smith_lambda(alpha, std::abs(wi.z)));
  if (wi.z > 0) {
    const glm::dvec3 h = glm::normalize(wo + wi);
    return walter_fresnel(glm::dot(wo, h), m.ior) * g * ggx(alpha, h.z) / (4.0 * wo.z * wi.z);
  }
  glm::dvec3 h = -(index_o * wo + index_i * wi);
  h = h.z < 0 ? -glm::normalize(h) : glm::normalize(h);
  const double o = glm::dot(wo, h), i = glm::dot(wi, h);
  if (o <= 0 || i >= 0) return 0;
  return m.transmittance.x * std::abs(i * o / (wo.z * wi.z)) * index_o * index_o * (1.0 - walter_fresnel(o, m.ior)) *
         g * ggx(alpha, h.z) / std::pow(index_i * i + index_o * o, 2);
}

/// Blinn 1977: cos^n of the half vector's angle; the integral that normalises it by the midpoint rule.
double blinn_phong(const GpuMaterial& m, glm::dvec3 wo, glm::dvec3 wi) {
  double integral = 0;
  constexpr int steps = 2000;
  for (int k = 0; k < steps; ++k) {
    const double theta = (k + 0.5) / steps * std::numbers::pi / 2;
    integral += std::pow(std::cos(theta / 2), m.exponent) * std::cos(theta) * std::sin(theta) * std::numbers::pi *
                std::numbers::pi / steps;
  }
  return m.base_color.x * std::numbers::inv_pi +
         m.reflectance.x * std::pow(glm::normalize(wo + wi).z, m.exponent) / integral;
}

GpuMaterial material(MaterialModel model, float roughness, float exponent = 0) {
  GpuMaterial m;
  m.model = model;
  m.base_color = glm::vec3(0.4f);
  m.reflectance = glm::vec3(0.6f);
  m.transmittance = glm::vec3(0.8f);
  m.roughness = roughness;
  m.exponent = exponent;
  m.ior = 1.5f;
  return m;
}

}  // namespace

TANDEM_DEVICE_TEST("BSDFs agree with the formulas of their papers") {
  struct Case {
    test::BsdfMaterial material;
    Formula formula;
  };
  GpuMaterial diamond = material(MaterialModel::rough_dielectric, 0.7f);
  diamond.ior = 2.4f;
  const std::vector<Case> cases = {
      {{"Oren-Nayar 0.2", material(MaterialModel::oren_nayar, 0.2f)}, oren_nayar},
      {{"Oren-Nayar 0.8", material(MaterialModel::oren_nayar, 0.8f)}, oren_nayar},
      {{"Phong 3", material(MaterialModel::phong, 0, 3)}, phong},
      {{"Phong 50", material(MaterialModel::phong, 0, 50)}, phong},
      {{"Blinn-Phong 3", material(MaterialModel::blinn_phong, 0, 3)}, blinn_phong},
      {{"Blinn-Phong 50", material(MaterialModel::blinn_phong, 0, 50)}, blinn_phong},
      {{"glass 0.4", material(MaterialModel::rough_dielectric, 0.4f)}, rough_dielectric},
      {{"glass 1", material(MaterialModel::rough_dielectric, 1)}, rough_dielectric},
      {{"diamond 0.7", diamond}, rough_dielectric},
  };
  constexpr std::size_t pairs = 500;
  test::RandomSource random(5);
  std::vector<test::BsdfMaterial> materials;
  std::vector<std::uint32_t> rows;
  std::vector<glm::vec3> directions;
  for (const Case& c : cases) {
    const auto index = static_cast<std::uint32_t>(materials.size());
    materials.push_back(c.material);
    const bool transmits = c.material.parameters.model == MaterialModel::rough_dielectric;
    for (std::size_t i = 0; i < pairs; ++i) {
      const glm::vec3 wo = test::direction_at(random.uniform(0.05, 1), random.uniform(-3, 3));
      glm::vec3 wi = test::direction_at(random.uniform(0.05, 1), random.uniform(-3, 3));
      if (transmits && i % 2 == 0) wi.z = -wi.z;
      rows.push_back(index);
      for (const float f : {wo.x, wo.y, wo.z, wi.x, wi.y, wi.z}) rows.push_back(std::bit_cast<std::uint32_t>(f));
      directions.insert(directions.end(), {wo, wi});
    }
  }
  const std::vector<std::uint32_t> outputs = test::run_bits(device,
                                                            test::bsdf_kernel(materials, R"(
    output_float(0, bsdf_evaluate(material(input_bits(0)), vec3(input_float(1), input_float(2), input_float(3)),
                                  vec3(input_float(4), input_float(5), input_float(6))).x);)",
                                                                              7, 1),
                                                            rows);
  for (std::size_t c = 0; c < cases.size(); ++c) {
    double worst = 0;
    int positive = 0;
    for (std::size_t i = c * pairs; i < (c + 1) * pairs; ++i) {
      const double expected = cases[c].formula(cases[c].material.parameters, glm::dvec3(directions[2 * i]),
                                               glm::dvec3(directions[2 * i + 1]));
      const double found = std::bit_cast<float>(outputs[i]);
      worst = std::max(worst, std::abs(found - expected) / std::max(expected, 1e-3));
      positive += expected > 0;
    }
    INFO(cases[c].material.name, ": ", worst);
    CHECK(positive > 200);
    // Roundings, grown by the exponents and by the lobes' slopes; Blinn's integral has the midpoint rule's error.
    CHECK(worst < 2e-5);
  }
}
