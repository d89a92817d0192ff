#include "rhi_cpu/trace/exact/triangle.hpp"

#include "rhi_cpu/trace/exact/bounded_number.hpp"
#include "rhi_cpu/trace/exact/exact_number.hpp"

namespace tandem::cpu::exact {
namespace {

enum class Answer { miss, hit, unknown };

/// With ExactNumber, the answer is never unknown.
template <class Number>
Answer intersect_with(const kernel::Ray& ray, const Transform& transform, const std::array<Position, 3>& corners,
                      TriangleHit& hit) {
  const Vector<Number> origin{std::span(ray.origin)};
  const Vector<Number> direction{std::span(ray.direction)};
  const Vector<Number> a = to_world<Number>(transform, corners[0]);
  const Vector<Number> b = to_world<Number>(transform, corners[1]);
  const Vector<Number> c = to_world<Number>(transform, corners[2]);
  const Vector<Number> ab = b - a;
  const Vector<Number> from_a = a - origin;

  // Which side of each edge the line passes: the volume that the direction spans with an edge, seen from the origin. An
  // edge gives the two triangles that share it opposite numbers, because the same points go in and nothing is rounded
  // by the time the sign is known. So of a closed mesh, no line between two triangles misses both.
  const Number at_a = dot(direction, cross(b - origin, c - b));
  const Number at_b = dot(direction, cross(c - origin, a - c));
  const Number at_c = dot(direction, cross(from_a, ab));
  const std::array<std::optional<int>, 3> sides = {sign_of(at_a), sign_of(at_b), sign_of(at_c)};
  bool left = false, right = false, unknown = false;
  for (const std::optional<int>& side : sides) {
    left = left || side == 1;
    right = right || side == -1;
    unknown = unknown || !side;
  }
  if (left && right) return Answer::miss;
  if (unknown) return Answer::unknown;
  // The line lies in the triangle's plane: Vulkan leaves open whether that is a hit.
  if (!left && !right) return Answer::miss;

  // at_a + at_b + at_c is the determinant too, which is not zero because none has the other sign.
  const Vector<Number> normal = cross(ab, c - a);
  const Number determinant = dot(direction, normal);
  const std::optional<float> t = rounded_quotient(dot(from_a, normal), determinant);
  const std::optional<float> u = rounded_quotient(at_b, determinant);
  const std::optional<float> v = rounded_quotient(at_c, determinant);
  if (!t || !u || !v) return Answer::unknown;
  hit.t = *t;
  hit.barycentrics = {*u, *v};
  // direction . normal of world space is that of object space times the determinant of the transform.
  hit.front_face = left != (transform.determinant_sign > 0);
  return Answer::hit;
}

}  // namespace

std::optional<TriangleHit> intersect(const kernel::Ray& ray, const Transform& transform,
                                     const std::array<Position, 3>& corners) {
  TriangleHit hit;
  Answer answer = intersect_with<BoundedNumber>(ray, transform, corners, hit);
  if (answer == Answer::unknown) answer = intersect_with<ExactNumber>(ray, transform, corners, hit);
  if (answer == Answer::miss) return std::nullopt;
  return hit;
}

}  // namespace tandem::cpu::exact
