#include "tools/weekend/conductor.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "tools/weekend/sampling.hpp"

namespace tandem::weekend {
namespace {

constexpr double pi = std::numbers::pi;
constexpr std::size_t cosines = 64;
constexpr int strata = 64;  ///< of each random number of a facet's normal

/// A normal that wo sees (Heitz, Sampling the GGX Distribution of Visible Normals, JCGT 7(4), 2018). u, v in [0, 1).
glm::dvec3 visible_normal(const glm::dvec3& wo, double alpha, double u, double v) {
  const glm::dvec3 view = glm::normalize(glm::dvec3(alpha * wo.x, alpha * wo.y, wo.z));
  const double across = view.x * view.x + view.y * view.y;
  const glm::dvec3 t1 = across > 0 ? glm::dvec3(-view.y, view.x, 0) / std::sqrt(across) : glm::dvec3(1, 0, 0);
  const glm::dvec3 t2 = glm::cross(view, t1);
  const double r = std::sqrt(u);
  const double p1 = r * std::cos(2 * pi * v);
  const double s = 0.5 * (1 + view.z);
  const double p2 = (1 - s) * std::sqrt(std::max(0.0, 1 - p1 * p1)) + s * r * std::sin(2 * pi * v);
  const glm::dvec3 n = p1 * t1 + p2 * t2 + std::sqrt(std::max(0.0, 1 - p1 * p1 - p2 * p2)) * view;
  return glm::normalize(glm::dvec3(alpha * n.x, alpha * n.y, std::max(1e-12, n.z)));
}

double distribution(const glm::dvec3& h, double alpha) {
  const double spread = h.z * h.z * (alpha * alpha - 1) + 1;
  return alpha * alpha / (pi * spread * spread);
}

}  // namespace

double Conductor::slant(const glm::dvec3& w) const { return std::sqrt(alpha_ * alpha_ * (1 - w.z * w.z) + w.z * w.z); }

Conductor::Conductor(Factor reflectance, double roughness)
    : reflectance_(std::move(reflectance)), alpha_(std::clamp(roughness * roughness, 1e-3, 1.0)) {
  for (std::size_t i = 0; i < cosines; ++i) {
    const double cosine = (static_cast<double>(i) + 0.5) / cosines;
    const glm::dvec3 wo(std::sqrt(1 - cosine * cosine), 0, cosine);
    double albedo = 0;
    for (int a = 0; a < strata; ++a) {
      for (int b = 0; b < strata; ++b) {
        const glm::dvec3 h = visible_normal(wo, alpha_, (a + 0.5) / strata, (b + 0.5) / strata);
        const glm::dvec3 wi = 2 * glm::dot(wo, h) * h - wo;
        if (!(wi.z > 0)) continue;
        // G2 / G1: what the density of visible normals leaves of the facets' BRDF.
        albedo += wi.z * (wo.z + slant(wo)) / (wo.z * slant(wi) + wi.z * slant(wo));
      }
    }
    losses_.push_back(std::max(0.0, 1 - albedo / (strata * strata)));
    mean_loss_ += 2 * losses_.back() * cosine / cosines;
  }
}

double Conductor::loss(double cosine) const {
  const double place = std::clamp(cosine * cosines - 0.5, 0.0, cosines - 1.0);
  const std::size_t step = std::min(static_cast<std::size_t>(place), cosines - 2);
  const double part = place - static_cast<double>(step);
  return losses_[step] * (1 - part) + losses_[step + 1] * part;
}

std::optional<Scattered> Conductor::scatter(const glm::dvec3& wo, bool, const glm::dvec2&, Random& random) const {
  if (random.uniform() < 0.5) return Scattered{.direction = cosine_direction(random)};
  const double u = random.uniform();
  const glm::dvec3 h = visible_normal(wo, alpha_, u, random.uniform());
  const glm::dvec3 wi = 2 * glm::dot(wo, h) * h - wo;
  if (!(wi.z > 0)) return std::nullopt;
  return Scattered{.direction = wi};
}

Scattering Conductor::value(const glm::dvec3& wo, const glm::dvec3& wi, const glm::dvec2& uv, bool) const {
  if (!(wo.z > 0 && wi.z > 0)) return {};
  const glm::dvec3 f0 = reflectance_.color(uv);
  const glm::dvec3 h = glm::normalize(wo + wi);
  const double cosine_h = std::max(0.0, glm::dot(wo, h));
  const double d = distribution(h, alpha_);
  const double g2 = 2 * wo.z * wi.z / (wo.z * slant(wi) + wi.z * slant(wo));
  const double g1 = 2 * wo.z / (wo.z + slant(wo));
  const glm::dvec3 fresnel = f0 + (1.0 - f0) * std::pow(1 - cosine_h, 5);
  const glm::dvec3 facets = fresnel * (d * g2 / (4 * wo.z * wi.z));
  const glm::dvec3 mean_fresnel = (20.0 * f0 + 1.0) / 21.0;
  const glm::dvec3 color = mean_fresnel * mean_fresnel * (1 - mean_loss_) / (1.0 - mean_fresnel * mean_loss_);
  const double lobe = mean_loss_ > 0 ? loss(wo.z) * loss(wi.z) / (pi * mean_loss_) : 0;
  return {.value = (facets + color * lobe) * wi.z, .density = 0.5 * g1 * d / (4 * wo.z) + 0.5 * wi.z / pi};
}

}  // namespace tandem::weekend
