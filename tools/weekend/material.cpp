#include "tools/weekend/material.hpp"

#include <utility>

namespace tandem::weekend {

glm::dvec3 Factor::color(const glm::dvec2& uv) const {
  return texture ? value * glm::dvec3(texture->value(uv)) : value;
}

double Factor::number(const glm::dvec2& uv) const {
  return texture ? value.x * channel_of(use, texture->value(uv)) : value.x;
}

Scattering Material::value(const glm::dvec3&, const glm::dvec3&, const glm::dvec2&, bool) const { return {}; }

void Material::set_opacity(Factor factor, double cutoff) {
  opacity_ = std::move(factor);
  cutoff_ = cutoff;
  opaque_ = !opacity_.texture && opacity_.value.x >= 1;
}

double Material::opacity(const glm::dvec2& uv) const {
  if (opaque_) return 1;
  const double fraction = opacity_.number(uv);
  if (cutoff_ > 0) return fraction >= cutoff_ ? 1 : 0;
  return fraction;
}

}  // namespace tandem::weekend
