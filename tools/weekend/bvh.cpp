#include "tools/weekend/bvh.hpp"

#include <algorithm>
#include <stdexcept>

namespace tandem::weekend {
namespace {

std::shared_ptr<const Hittable> tree(std::span<std::shared_ptr<const Hittable>> objects) {
  if (objects.size() == 1) return objects.front();
  return std::make_shared<BvhNode>(objects);
}

}  // namespace

BvhNode::BvhNode(std::span<std::shared_ptr<const Hittable>> objects) {
  box_ = objects.front()->bounds();
  for (const std::shared_ptr<const Hittable>& object : objects) box_ = around(box_, object->bounds());
  const glm::dvec3 extent = box_.maximum - box_.minimum;
  int axis = extent.y > extent.x ? 1 : 0;
  if (extent.z > extent[axis]) axis = 2;
  const auto middle = objects.begin() + static_cast<std::ptrdiff_t>(objects.size() / 2);
  std::nth_element(objects.begin(), middle, objects.end(), [axis](const auto& a, const auto& b) {
    const Box box_a = a->bounds();
    const Box box_b = b->bounds();
    return box_a.minimum[axis] + box_a.maximum[axis] < box_b.minimum[axis] + box_b.maximum[axis];
  });
  const std::size_t half = objects.size() / 2;
  if (half == 0) {
    left_ = objects.front();
    return;
  }
  left_ = tree(objects.first(half));
  right_ = tree(objects.subspan(half));
}

std::optional<Hit> BvhNode::hit(const Ray& ray, double t_min, double t_max, Random& random) const {
  if (!meets(box_, ray, t_min, t_max)) return std::nullopt;
  std::optional<Hit> closest = left_->hit(ray, t_min, t_max, random);
  if (right_)
    if (std::optional<Hit> closer = right_->hit(ray, t_min, closest ? closest->t : t_max, random)) closest = closer;
  return closest;
}

glm::dvec3 BvhNode::sample_direction(const glm::dvec3&, Random&) const { throw std::logic_error("a tree is no light"); }
double BvhNode::direction_density(const Ray&) const { throw std::logic_error("a tree is no light"); }

}  // namespace tandem::weekend
