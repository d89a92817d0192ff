#pragma once

#include <memory>
#include <span>

#include "tools/weekend/hittable.hpp"

namespace tandem::weekend {

/// A node of the hierarchy of The Next Week, chapter 3: two children, split at the median of the longest axis.
class BvhNode final : public Hittable {
 public:
  /// @param objects at least one; sorted by this
  explicit BvhNode(std::span<std::shared_ptr<const Hittable>> objects);

  std::optional<Hit> hit(const Ray& ray, double t_min, double t_max, Random& random) const override;
  Box bounds() const override { return box_; }
  /// No light is one: these throw std::logic_error.
  glm::dvec3 sample_direction(const glm::dvec3& origin, Random& random) const override;
  double direction_density(const Ray& ray) const override;

 private:
  std::shared_ptr<const Hittable> left_, right_;  ///< right: none where there is one object
  Box box_;
};

}  // namespace tandem::weekend
