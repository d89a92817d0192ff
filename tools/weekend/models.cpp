#include "tools/weekend/models.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "base/error.hpp"
#include "tools/weekend/conductor.hpp"
#include "tools/weekend/frame.hpp"
#include "tools/weekend/sampling.hpp"

namespace tandem::weekend {
namespace {

using pathtracer::GpuMaterial;
using pathtracer::MaterialModel;

constexpr double pi = std::numbers::pi;
constexpr double largest_exponent = 1e4;  ///< what Tandem takes sharper lobes for

double largest(const glm::dvec3& color) { return std::max({color.x, color.y, color.z}); }

class Lambertian final : public Material {
 public:
  explicit Lambertian(Factor albedo) : albedo_(std::move(albedo)) {}
  std::optional<Scattered> scatter(const glm::dvec3&, bool, const glm::dvec2&, Random& random) const override {
    return Scattered{.direction = cosine_direction(random)};
  }
  Scattering value(const glm::dvec3&, const glm::dvec3& wi, const glm::dvec2& uv, bool) const override {
    if (!(wi.z > 0)) return {};
    return {.value = albedo_.color(uv) * (wi.z / pi), .density = wi.z / pi};
  }

 private:
  Factor albedo_;
};

class Mirror final : public Material {
 public:
  explicit Mirror(Factor reflectance) : reflectance_(std::move(reflectance)) {}
  bool has_density() const override { return false; }
  std::optional<Scattered> scatter(const glm::dvec3& wo, bool, const glm::dvec2& uv, Random&) const override {
    return Scattered{.direction = {-wo.x, -wo.y, wo.z}, .weight = reflectance_.color(uv)};
  }

 private:
  Factor reflectance_;
};

/// Snell's law and Fresnel's equations. Radiance is scaled by the square of the relative index where it is refracted.
class Dielectric final : public Material {
 public:
  Dielectric(double ior, Factor transmittance) : ior_(ior), transmittance_(std::move(transmittance)) {}
  bool has_density() const override { return false; }
  std::optional<Scattered> scatter(const glm::dvec3& wo, bool outside, const glm::dvec2& uv,
                                   Random& random) const override {
    const double eta = outside ? ior_ : 1 / ior_;
    const double sine2 = (1 - wo.z * wo.z) / (eta * eta);
    const glm::dvec3 reflected(-wo.x, -wo.y, wo.z);
    const double chosen = random.uniform();
    if (sine2 >= 1) return Scattered{.direction = reflected};
    const double cosine = std::sqrt(1 - sine2);
    const double parallel = (eta * wo.z - cosine) / (eta * wo.z + cosine);
    const double perpendicular = (wo.z - eta * cosine) / (wo.z + eta * cosine);
    if (chosen < 0.5 * (parallel * parallel + perpendicular * perpendicular)) return Scattered{.direction = reflected};
    return Scattered{.direction = {-wo.x / eta, -wo.y / eta, -cosine},
                     .weight = transmittance_.color(uv) / (eta * eta),
                     .transmitted = true};
  }

 private:
  double ior_;
  Factor transmittance_;
};

/// Lambert and a lobe around the mirror direction or the half vector.
class Glossy : public Material {
 public:
  Glossy(Factor albedo, Factor reflectance, Factor exponent)
      : albedo_(std::move(albedo)), reflectance_(std::move(reflectance)), exponent_(std::move(exponent)) {}
  bool folds() const override { return true; }
  std::optional<Scattered> scatter(const glm::dvec3& wo, bool, const glm::dvec2& uv, Random& random) const override {
    if (random.uniform() < diffuse_probability(uv)) return Scattered{.direction = cosine_direction(random)};
    const glm::dvec3 wi = lobe_direction(wo, exponent(uv), random);
    if (!(wi.z > 0)) return std::nullopt;
    return Scattered{.direction = wi};
  }
  Scattering value(const glm::dvec3& wo, const glm::dvec3& wi, const glm::dvec2& uv, bool glossy_only) const override {
    if (!(wo.z > 0 && wi.z > 0)) return {};
    const Scattering lobe = lobe_value(wo, wi, exponent(uv));
    const double diffuse = diffuse_probability(uv);
    const glm::dvec3 base = glossy_only ? glm::dvec3(0) : albedo_.color(uv) / pi;
    return {.value = (base + reflectance_.color(uv) * lobe.value) * wi.z,
            .density = diffuse * wi.z / pi + (1 - diffuse) * lobe.density};
  }

 private:
  virtual glm::dvec3 lobe_direction(const glm::dvec3& wo, double n, Random& random) const = 0;
  /// Without the cosine.
  virtual Scattering lobe_value(const glm::dvec3& wo, const glm::dvec3& wi, double n) const = 0;

  double exponent(const glm::dvec2& uv) const { return std::clamp(exponent_.number(uv), 0.0, largest_exponent); }
  double diffuse_probability(const glm::dvec2& uv) const {
    const double diffuse = largest(albedo_.color(uv));
    const double sum = diffuse + largest(reflectance_.color(uv));
    return sum > 0 ? diffuse / sum : 1;
  }

  Factor albedo_, reflectance_, exponent_;
};

/// Lafortune and Willems, Using the Modified Phong Reflectance Model for Physically Based Rendering, CW 197 (1994).
class Phong final : public Glossy {
 public:
  using Glossy::Glossy;

 private:
  glm::dvec3 lobe_direction(const glm::dvec3& wo, double n, Random& random) const override {
    return Frame(glm::dvec3(-wo.x, -wo.y, wo.z)).to_world(power_cosine_direction(n, random));
  }
  Scattering lobe_value(const glm::dvec3& wo, const glm::dvec3& wi, double n) const override {
    const double cosine = glm::dot(glm::dvec3(-wo.x, -wo.y, wo.z), wi);
    const double power = cosine > 0 ? std::pow(cosine, n) : 0;
    return {.value = glm::dvec3((n + 2) / (2 * pi) * power), .density = (n + 1) / (2 * pi) * power};
  }
};

/// Normalised such that at normal incidence the lobe reflects `reflectance`: (n + 2) (n + 4) / (8 pi (2^(-n/2) + n)).
class BlinnPhong final : public Glossy {
 public:
  using Glossy::Glossy;

 private:
  glm::dvec3 lobe_direction(const glm::dvec3& wo, double n, Random& random) const override {
    const glm::dvec3 h = power_cosine_direction(n, random);
    return 2 * glm::dot(wo, h) * h - wo;
  }
  Scattering lobe_value(const glm::dvec3& wo, const glm::dvec3& wi, double n) const override {
    const glm::dvec3 h = glm::normalize(wo + wi);
    const double power = std::pow(std::max(0.0, h.z), n);
    const double along = glm::dot(wo, h);
    return {.value = glm::dvec3((n + 2) * (n + 4) / (8 * pi * (std::pow(2.0, -n / 2) + n)) * power),
            .density = along > 0 ? (n + 1) / (2 * pi) * power / (4 * along) : 0};
  }
};

Factor factor(const pathtracer::Scene& scene, glm::vec3 value, std::uint32_t texture) {
  Factor result{.value = value, .texture = {}, .use = {}};
  if (texture != pathtracer::no_texture) {
    result.texture = make_texture(scene, texture);
    result.use = scene.textures[texture];
  }
  return result;
}

std::unique_ptr<Material> model_of(const pathtracer::Scene& scene, const GpuMaterial& given) {
  const Factor albedo = factor(scene, given.base_color, given.base_color_texture);
  const Factor reflectance = factor(scene, given.reflectance, given.reflectance_texture);
  const Factor exponent = factor(scene, glm::vec3(given.exponent), given.exponent_texture);
  switch (given.model) {
    case MaterialModel::diffuse:
      return std::make_unique<Lambertian>(albedo);
    case MaterialModel::mirror:
      return std::make_unique<Mirror>(reflectance);
    case MaterialModel::dielectric:
      return std::make_unique<Dielectric>(given.ior, factor(scene, given.transmittance, given.transmittance_texture));
    case MaterialModel::phong:
      return std::make_unique<Phong>(albedo, reflectance, exponent);
    case MaterialModel::blinn_phong:
      return std::make_unique<BlinnPhong>(albedo, reflectance, exponent);
    case MaterialModel::conductor:
      if (given.eta != glm::vec3(0) || given.roughness_texture != pathtracer::no_texture)
        throw Error("the baseline has no metals by their index of refraction and no textures of the roughness");
      return std::make_unique<Conductor>(reflectance, given.roughness);
    default:
      throw Error("the baseline has the models diffuse, mirror, dielectric, phong, blinn-phong and conductor only");
  }
}

}  // namespace

std::unique_ptr<Material> make_material(const pathtracer::Scene& scene, std::size_t index) {
  const GpuMaterial& given = scene.materials[index];
  try {
    if (given.normal_texture != pathtracer::no_texture || given.bump_texture != pathtracer::no_texture)
      throw Error("the baseline has no normal and no bump maps");
    if (given.attributes != 0) throw Error("the baseline has no colours, opacities or tangents of vertices");
    std::unique_ptr<Material> material = model_of(scene, given);
    material->set_emission(factor(scene, given.emission, given.emission_texture));
    material->set_opacity(factor(scene, glm::vec3(given.opacity), given.alpha_texture), given.alpha_cutoff);
    return material;
  } catch (const Error& error) {
    throw Error(fmt::format("{}: material {}: {}", scene.name, scene.material_names[index], error.what()));
  }
}

}  // namespace tandem::weekend
