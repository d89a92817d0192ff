#include "rhi_cpu/trace/exact/box.hpp"

#include <cmath>
#include <cstddef>

#include "rhi_cpu/trace/exact/bounded_number.hpp"
#include "rhi_cpu/trace/exact/exact_number.hpp"

namespace tandem::cpu::exact {
namespace {

enum class Answer { miss, hit, unknown };

/// A t as numerator / denominator, the denominator positive.
template <class Number>
struct Fraction {
  Number numerator;
  Number denominator;
};

template <class Number>
std::optional<int> compare(const Fraction<Number>& a, const Fraction<Number>& b) {
  return sign_of(a.numerator * b.denominator - b.numerator * a.denominator);
}

/// With ExactNumber, the answer is never unknown.
template <class Number>
Answer entry_with(const kernel::Ray& ray, const Transform& transform, const Box& box, float& t) {
  // In object space the ray is (p + t q) / determinant, where p and q are polynomials in floats. With the sign of the
  // determinant moved to p and q it is positive, and minimum <= object space <= maximum reads
  // minimum * determinant <= p + t q <= maximum * determinant.
  const Adjugate<Number> adjugate = adjugate_of<Number>(transform);
  const Vector<Number> translation(Number(transform.rows[0][3]), Number(transform.rows[1][3]),
                                   Number(transform.rows[2][3]));
  const Vector<Number> from_translation = Vector<Number>(std::span(ray.origin)) - translation;
  const Vector<Number> direction{std::span(ray.direction)};
  const bool mirrors = transform.determinant_sign < 0;
  const auto signed_by_determinant = [&](const Number& number) { return mirrors ? -number : number; };
  const Number determinant = signed_by_determinant(adjugate.determinant);

  Fraction<Number> first{Number(ray.t_min), Number(1.0f)};
  std::optional<Fraction<Number>> last;
  if (std::isfinite(ray.t_max)) last = {Number(ray.t_max), Number(1.0f)};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Number p = signed_by_determinant(dot(adjugate.rows[axis], from_translation));
    const Number q = signed_by_determinant(dot(adjugate.rows[axis], direction));
    const Number to_minimum = Number(box.minimum[axis]) * determinant - p;
    const Number to_maximum = Number(box.maximum[axis]) * determinant - p;
    const std::optional<int> side = sign_of(q);
    if (!side) return Answer::unknown;
    if (*side == 0) {
      // The ray runs between the planes of this axis, or on one, or passes the box by.
      const std::optional<int> above_minimum = sign_of(-to_minimum);
      const std::optional<int> below_maximum = sign_of(to_maximum);
      if (!above_minimum || !below_maximum) return Answer::unknown;
      if (*above_minimum < 0 || *below_maximum < 0) return Answer::miss;
      continue;
    }
    const bool forward = *side > 0;
    const Number denominator = forward ? q : -q;
    const Fraction<Number> enter{forward ? to_minimum : -to_maximum, denominator};
    const Fraction<Number> exit{forward ? to_maximum : -to_minimum, denominator};
    const std::optional<int> later = compare(enter, first);
    const std::optional<int> earlier = last ? compare(exit, *last) : std::optional<int>(-1);
    if (!later || !earlier) return Answer::unknown;
    if (*later > 0) first = enter;
    if (*earlier < 0) last = exit;
  }
  const std::optional<int> order = last ? compare(first, *last) : std::optional<int>(-1);
  if (!order) return Answer::unknown;
  if (*order > 0) return Answer::miss;
  const std::optional<float> rounded = rounded_quotient(first.numerator, first.denominator);
  if (!rounded) return Answer::unknown;
  t = *rounded;
  return Answer::hit;
}

}  // namespace

std::optional<float> entry_of(const kernel::Ray& ray, const Transform& transform, const Box& box) {
  float t = 0;
  Answer answer = entry_with<BoundedNumber>(ray, transform, box, t);
  if (answer == Answer::unknown) answer = entry_with<ExactNumber>(ray, transform, box, t);
  // Beyond all floats, which is where a ray without an end may enter the box.
  if (answer == Answer::miss || std::isinf(t)) return std::nullopt;
  return t;
}

}  // namespace tandem::cpu::exact
