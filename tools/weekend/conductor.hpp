#pragma once

#include <vector>

#include "tools/weekend/material.hpp"

namespace tandem::weekend {

/// A rough metal: facets after Trowbridge and Reitz with Smith's height-correlated shadowing (Heitz, JCGT 3(2), 2014),
/// Schlick's reflectance, and Kulla and Conty's lobe for what facets reflect among themselves (SIGGRAPH 2017 course).
/// The albedos that the lobe needs are integrated numerically here.
class Conductor final : public Material {
 public:
  /// @param roughness in (0, 1]; the width of the distribution is its square
  Conductor(Factor reflectance, double roughness);

  bool folds() const override { return true; }
  std::optional<Scattered> scatter(const glm::dvec3& wo, bool outside, const glm::dvec2& uv,
                                   Random& random) const override;
  Scattering value(const glm::dvec3& wo, const glm::dvec3& wi, const glm::dvec2& uv, bool glossy_only) const override;

 private:
  double loss(double cosine) const;  ///< 1 - the albedo of facets that reflect everything once
  double slant(const glm::dvec3& w) const;

  Factor reflectance_;
  double alpha_;
  std::vector<double> losses_;  ///< at equally spaced cosines, those of the middle of each step
  double mean_loss_ = 0;
};

}  // namespace tandem::weekend
