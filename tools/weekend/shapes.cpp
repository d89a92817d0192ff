#include "tools/weekend/shapes.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "tools/weekend/frame.hpp"
#include "tools/weekend/material.hpp"

namespace tandem::weekend {

Triangle::Triangle(const std::array<Corner, 3>& corners, bool smooth, const Material* material)
    : corners_(corners), smooth_(smooth), material_(material) {
  const glm::dvec3 cross =
      glm::cross(corners[1].position - corners[0].position, corners[2].position - corners[0].position);
  const double length = glm::length(cross);
  area_ = 0.5 * length;
  normal_ = length > 0 ? cross / length : glm::dvec3(0);
}

std::optional<Triangle::Place> Triangle::meet(const Ray& ray) const {
  // Möller and Trumbore, Fast, Minimum Storage Ray/Triangle Intersection (1997).
  const glm::dvec3 edge_b = corners_[1].position - corners_[0].position;
  const glm::dvec3 edge_c = corners_[2].position - corners_[0].position;
  const glm::dvec3 p = glm::cross(ray.direction, edge_c);
  const double determinant = glm::dot(edge_b, p);
  if (determinant == 0 || area_ == 0) return std::nullopt;
  const glm::dvec3 s = ray.origin - corners_[0].position;
  const double b = glm::dot(s, p) / determinant;
  if (b < 0 || b > 1) return std::nullopt;
  const glm::dvec3 q = glm::cross(s, edge_b);
  const double c = glm::dot(ray.direction, q) / determinant;
  if (c < 0 || b + c > 1) return std::nullopt;
  return Place{.t = glm::dot(edge_c, q) / determinant, .b = b, .c = c};
}

std::optional<Hit> Triangle::hit(const Ray& ray, double t_min, double t_max, Random& random) const {
  const std::optional<Place> place = meet(ray);
  if (!place || !(place->t > t_min && place->t < t_max)) return std::nullopt;
  const double a = 1 - place->b - place->c;
  Hit hit;
  hit.t = place->t;
  hit.position = ray.at(place->t);
  hit.outside = glm::dot(ray.direction, normal_) <= 0;
  hit.normal = hit.outside ? normal_ : -normal_;
  hit.shading_normal = hit.normal;
  hit.uv = a * corners_[0].uv + place->b * corners_[1].uv + place->c * corners_[2].uv;
  hit.material = material_;
  const double opacity = material_->opacity(hit.uv);
  if (opacity < 1 && random.uniform() >= opacity) return std::nullopt;
  if (!smooth_) return hit;
  const glm::dvec3 sum = a * corners_[0].normal + place->b * corners_[1].normal + place->c * corners_[2].normal;
  if (!(glm::length(sum) > 0)) return hit;
  glm::dvec3 interpolated = glm::normalize(sum);
  if (glm::dot(interpolated, hit.normal) < 0) interpolated = -interpolated;
  // Seen from behind, it means nothing.
  if (glm::dot(interpolated, ray.direction) < 0) hit.shading_normal = interpolated;
  return hit;
}

Box Triangle::bounds() const {
  const glm::dvec3 &a = corners_[0].position, &b = corners_[1].position, &c = corners_[2].position;
  const Box box{.minimum = glm::min(a, glm::min(b, c)), .maximum = glm::max(a, glm::max(b, c))};
  // A box without thickness could be missed by rounding.
  const glm::dvec3 margin = 1e-12 * (glm::abs(box.minimum) + glm::abs(box.maximum)) + 1e-30;
  return {.minimum = box.minimum - margin, .maximum = box.maximum + margin};
}

glm::dvec3 Triangle::sample_direction(const glm::dvec3& origin, Random& random) const {
  const double root = std::sqrt(random.uniform());
  const double b = root * (1 - random.uniform());
  const double a = 1 - root;
  return a * corners_[0].position + b * corners_[1].position + (1 - a - b) * corners_[2].position - origin;
}

double Triangle::direction_density(const Ray& ray) const {
  const std::optional<Place> place = meet(ray);
  if (!place || !(place->t > 0)) return 0;
  const double cosine = std::abs(glm::dot(ray.direction, normal_));
  return cosine > 0 ? place->t * place->t / (cosine * area_) : 0;
}

Sphere::Sphere(const glm::dvec3& centre, double radius, const Material* material)
    : centre_(centre), radius_(radius), material_(material) {}

std::optional<Hit> Sphere::hit(const Ray& ray, double t_min, double t_max, Random&) const {
  const glm::dvec3 to_origin = ray.origin - centre_;
  const double half_b = glm::dot(to_origin, ray.direction);
  const double discriminant = half_b * half_b - (glm::dot(to_origin, to_origin) - radius_ * radius_);
  if (discriminant < 0) return std::nullopt;
  const double root = std::sqrt(discriminant);
  double t = -half_b - root;
  if (!(t > t_min && t < t_max)) t = -half_b + root;
  if (!(t > t_min && t < t_max)) return std::nullopt;
  Hit hit;
  hit.t = t;
  hit.position = ray.at(t);
  const glm::dvec3 outward = (hit.position - centre_) / radius_;
  hit.outside = glm::dot(ray.direction, outward) <= 0;
  hit.normal = hit.outside ? outward : -outward;
  hit.shading_normal = hit.normal;
  hit.material = material_;
  return hit;
}

Box Sphere::bounds() const { return {.minimum = centre_ - radius_, .maximum = centre_ + radius_}; }

glm::dvec3 Sphere::sample_direction(const glm::dvec3& origin, Random& random) const {
  const glm::dvec3 to_centre = centre_ - origin;
  const double squared_sine = radius_ * radius_ / glm::dot(to_centre, to_centre);
  const double widest = squared_sine < 1 ? std::sqrt(1 - squared_sine) : -1;
  const double cosine = 1 + random.uniform() * (widest - 1);
  const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
  const double turn = 2 * std::numbers::pi * random.uniform();
  return Frame(glm::normalize(to_centre)).to_world({std::cos(turn) * sine, std::sin(turn) * sine, cosine});
}

double Sphere::direction_density(const Ray& ray) const {
  Random unused(0);
  const double far = std::numeric_limits<double>::infinity();
  if (!hit(ray, 0, far, unused)) return 0;
  const glm::dvec3 to_centre = centre_ - ray.origin;
  const double squared_sine = radius_ * radius_ / glm::dot(to_centre, to_centre);
  const double widest = squared_sine < 1 ? std::sqrt(1 - squared_sine) : -1;
  return 1 / (2 * std::numbers::pi * (1 - widest));
}

}  // namespace tandem::weekend
