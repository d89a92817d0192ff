#pragma once

#include <span>

namespace tandem::cpu::exact {

/// Three numbers of a kind: BoundedNumber or ExactNumber.
template <class Number>
struct Vector {
  Number x, y, z;

  Vector(const Number& x_, const Number& y_, const Number& z_) : x(x_), y(y_), z(z_) {}
  explicit Vector(std::span<const float, 3> v) : x(v[0]), y(v[1]), z(v[2]) {}
};

template <class Number>
Vector<Number> operator-(const Vector<Number>& a, const Vector<Number>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}

template <class Number>
Number dot(const Vector<Number>& a, const Vector<Number>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

template <class Number>
Vector<Number> cross(const Vector<Number>& a, const Vector<Number>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

}  // namespace tandem::cpu::exact
