#include "tests/shaders/bsdf_materials.hpp"

#include <cmath>

#include <fmt/format.h>

namespace tandem::test {
namespace {

using pathtracer::GpuMaterial;
using pathtracer::MaterialModel;

std::string glsl(glm::vec3 v) { return fmt::format("vec3({:.9e}, {:.9e}, {:.9e})", v.x, v.y, v.z); }

std::string assignments(const BsdfMaterial& material) {
  const GpuMaterial& m = material.parameters;
  return fmt::format(
      "p.model = {}; p.base_color = {}; p.reflectance = {}; p.transmittance = {}; p.ior = {:.9e}; p.outside = {}; "
      "p.eta = {}; p.absorption = {}; p.roughness = {:.9e}; p.metallic = {:.9e}; p.exponent = {:.9e}; "
      "p.transmission = {:.9e}; p.specular = {:.9e};",
      static_cast<std::uint32_t>(m.model), glsl(m.base_color), glsl(m.reflectance), glsl(m.transmittance), m.ior,
      material.outside, glsl(m.eta), glsl(m.absorption), m.roughness, m.metallic, m.exponent, m.transmission,
      m.specular);
}

GpuMaterial glossy_material(MaterialModel model, float diffuse, float lobe, float exponent) {
  GpuMaterial material;
  material.model = model;
  material.base_color = glm::vec3(diffuse, 0.5f * diffuse, 0);
  material.reflectance = glm::vec3(0.5f * lobe, lobe, 0.25f * lobe);
  material.exponent = exponent;
  return material;
}

GpuMaterial conductor_material(float roughness, glm::vec3 reflectance, glm::vec3 eta = {}, glm::vec3 absorption = {}) {
  GpuMaterial material;
  material.model = MaterialModel::conductor;
  material.roughness = roughness;
  material.reflectance = reflectance;
  material.eta = eta;
  material.absorption = absorption;
  return material;
}

GpuMaterial dielectric_material(MaterialModel model, float roughness, float ior,
                                glm::vec3 transmittance = glm::vec3(1)) {
  GpuMaterial material;
  material.model = model;
  material.roughness = roughness;
  material.ior = ior;
  material.transmittance = transmittance;
  return material;
}

GpuMaterial principled_material(float roughness, float metallic, float transmission,
                                glm::vec3 base_color = glm::vec3(1), float specular = 1) {
  GpuMaterial material;
  material.model = MaterialModel::principled;
  material.base_color = base_color;
  material.reflectance = glm::vec3(1);
  material.ior = 1.5f;
  material.roughness = roughness;
  material.metallic = metallic;
  material.transmission = transmission;
  material.specular = specular;
  return material;
}

GpuMaterial diffuse_material(MaterialModel model, float roughness) {
  GpuMaterial material;
  material.model = model;
  material.base_color = glm::vec3(1, 0.5f, 0.25f);
  material.roughness = roughness;
  return material;
}

}  // namespace

std::vector<BsdfMaterial> wide_materials() {
  using enum MaterialModel;
  const glm::vec3 gold_eta(0.156f, 0.424f, 1.383f), gold_absorption(3.602f, 2.472f, 1.915f);
  return {
      {"Lambert", diffuse_material(MaterialModel::diffuse, 0)},
      {"Oren-Nayar, sigma 0", diffuse_material(oren_nayar, 0)},
      {"Oren-Nayar, sigma 0.35", diffuse_material(oren_nayar, 0.35f)},
      {"Oren-Nayar, sigma 1.2", diffuse_material(oren_nayar, 1.2f)},
      {"Phong, exponent 0", glossy_material(phong, 0.3f, 0.7f, 0)},
      {"Phong, exponent 20", glossy_material(phong, 0.5f, 0.5f, 20)},
      {"Phong, lobe alone", glossy_material(phong, 0, 1, 60)},
      {"Blinn-Phong, exponent 0", glossy_material(blinn_phong, 0.3f, 0.7f, 0)},
      {"Blinn-Phong, exponent 20", glossy_material(blinn_phong, 0.5f, 0.5f, 20)},
      {"Blinn-Phong, lobe alone", glossy_material(blinn_phong, 0, 1, 200)},
      {"white conductor, roughness 0.45", conductor_material(0.45f, glm::vec3(1))},
      {"white conductor, roughness 0.7", conductor_material(0.7f, glm::vec3(1))},
      {"white conductor, roughness 1", conductor_material(1, glm::vec3(1))},
      {"gold, roughness 0.5", conductor_material(0.5f, glm::vec3(0), gold_eta, gold_absorption)},
      {"Schlick conductor", conductor_material(0.6f, glm::vec3(0.9f, 0.5f, 0.04f))},
      {"rough glass from outside", dielectric_material(rough_dielectric, 0.5f, 1.5f)},
      {"rough glass from inside", dielectric_material(rough_dielectric, 0.5f, 1.5f), false},
      {"rough tinted diamond", dielectric_material(rough_dielectric, 0.8f, 2.4f, glm::vec3(1, 0.5f, 0.25f))},
      {"rough bubble", dielectric_material(rough_dielectric, 0.6f, 0.75f)},
      {"principled plastic", principled_material(0.5f, 0, 0)},
      {"principled colour", principled_material(0.7f, 0, 0, glm::vec3(0.9f, 0.1f, 0.4f), 0.5f)},
      {"principled metal", principled_material(0.6f, 1, 0)},
      {"principled mixture", principled_material(0.6f, 0.4f, 0.3f, glm::vec3(0.9f, 0.6f, 0.3f))},
      {"principled sheet", principled_material(0.5f, 0, 1)},
      {"principled, roughness 1", principled_material(1, 0, 0.5f)},
  };
}

std::vector<BsdfMaterial> extreme_materials() {
  using enum MaterialModel;
  GpuMaterial no_index = principled_material(0.3f, 0, 0);
  no_index.ior = 0;
  GpuMaterial black = principled_material(0.3f, 0, 0, glm::vec3(0), 0);
  GpuMaterial everything = principled_material(2, 2, 2, glm::vec3(1), 2);
  return {
      {"Oren-Nayar, sigma 1e-20", diffuse_material(oren_nayar, 1e-20f)},
      {"Phong, exponent 1e9", glossy_material(phong, 0, 1, 1e9f)},
      {"Phong, exponent -1", glossy_material(phong, 0.5f, 0.5f, -1)},
      {"Phong, black", glossy_material(phong, 0, 0, 10)},
      {"Blinn-Phong, exponent 1e9", glossy_material(blinn_phong, 0, 1, 1e9f)},
      {"Blinn-Phong, exponent 1000", glossy_material(blinn_phong, 0.2f, 0.8f, 1000)},
      {"conductor, roughness 0", conductor_material(0, glm::vec3(1))},
      {"conductor, roughness 0.05", conductor_material(0.05f, glm::vec3(1))},
      {"conductor, roughness 0.2", conductor_material(0.2f, glm::vec3(1))},
      {"conductor, roughness 9", conductor_material(9, glm::vec3(1))},
      {"conductor, black", conductor_material(0.3f, glm::vec3(0))},
      {"conductor with one index", conductor_material(0.3f, glm::vec3(0), glm::vec3(1, 0, 0), glm::vec3(0))},
      {"rough glass, roughness 0", dielectric_material(rough_dielectric, 0, 1.5f)},
      {"rough glass from inside, roughness 0", dielectric_material(rough_dielectric, 0, 1.5f), false},
      {"rough glass, roughness 0.2", dielectric_material(rough_dielectric, 0.2f, 1.5f)},
      {"rough glass, roughness 1", dielectric_material(rough_dielectric, 1, 1.5f)},
      {"rough glass from inside, roughness 1", dielectric_material(rough_dielectric, 1, 1.5f), false},
      {"rough glass, index 1.011", dielectric_material(rough_dielectric, 0, 1.011f)},
      {"rough glass, index 1000", dielectric_material(rough_dielectric, 0.3f, 1000)},
      {"principled, roughness 0", principled_material(0, 0, 0)},
      {"principled metal, roughness 0", principled_material(0, 1, 0)},
      {"principled sheet, roughness 0", principled_material(0, 0, 1)},
      {"principled, index 0", no_index},
      {"principled, black", black},
      {"principled, beyond its ranges", everything},
  };
}

std::vector<BsdfMaterial> specular_materials() {
  using enum MaterialModel;
  GpuMaterial reflecting;
  reflecting.model = mirror;
  reflecting.reflectance = glm::vec3(0.9f, 0.5f, 1);
  return {
      {"mirror", reflecting},
      {"glass from outside", dielectric_material(MaterialModel::dielectric, 0, 1.5f)},
      {"glass from inside", dielectric_material(MaterialModel::dielectric, 0, 1.5f), false},
      {"rough glass without an interface", dielectric_material(rough_dielectric, 0.5f, 1)},
      {"pane", dielectric_material(thin, 0, 1.5f)},
      {"tinted pane", dielectric_material(thin, 0, 1.5f, glm::vec3(0.5f, 0.9f, 0))},
      {"pane without an interface", dielectric_material(thin, 0, 1)},
      {"boundary", dielectric_material(boundary, 0, 1)},
  };
}

FunctionKernel bsdf_kernel(const std::vector<BsdfMaterial>& materials, const std::string& body,
                           std::uint32_t input_count, std::uint32_t output_count) {
  std::string table;
  for (std::size_t i = 0; i < materials.size(); ++i)
    table += fmt::format("  if (index == {}) {{ {} }}\n", i, assignments(materials[i]));
  return {.includes = fmt::format(R"(#define TANDEM_FEATURES
const bool FEATURE_MATERIALS = true;
#include "bsdf/models.glsl"
BsdfParameters material(uint index) {{
  BsdfParameters p;
  p.glossy_only = false;
{}  return p;
}})",
                                  table),
          .body = body,
          .input_count = input_count,
          .output_count = output_count};
}

glm::vec3 direction_at(double cosine, double azimuth) {
  const double sine = std::sqrt(1.0 - cosine * cosine);
  return {sine * std::cos(azimuth), sine * std::sin(azimuth), cosine};
}

}  // namespace tandem::test
