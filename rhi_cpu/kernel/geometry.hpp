#pragma once

#include <cmath>

#include "rhi_cpu/kernel/math.hpp"
#include "rhi_cpu/kernel/types.hpp"

/// GLSL's geometric functions, each with the order of operations that Mesa uses, so that results agree with lavapipe to
/// the last bit.
namespace tandem::kernel {

template <int length, typename T>
constexpr T dot(const glm::vec<length, T>& a, const glm::vec<length, T>& b) {
  T sum = a[0] * b[0];
  for (int i = 1; i < length; ++i) sum = sum + a[i] * b[i];
  return sum;
}

template <typename T>
constexpr glm::vec<3, T> cross(const glm::vec<3, T>& a, const glm::vec<3, T>& b) {
  return {a.y * b.z - b.y * a.z, a.z * b.x - b.z * a.x, a.x * b.y - b.x * a.y};
}

template <int size, typename T>
inline T length(const glm::vec<size, T>& v) {
  return kernel::sqrt(kernel::dot(v, v));
}
template <typename T>
inline T length(T x) {
  return kernel::abs(x);
}

template <typename T>
inline auto distance(const T& a, const T& b) {
  return kernel::length(a - b);
}

template <int length, typename T>
inline glm::vec<length, T> normalize(const glm::vec<length, T>& v) {
  return v / kernel::sqrt(kernel::dot(v, v));
}
template <typename T>
inline T normalize(T x) {
  return kernel::sign(x);
}

template <int length, typename T>
inline glm::vec<length, T> face_forward(const glm::vec<length, T>& n, const glm::vec<length, T>& incident,
                                        const glm::vec<length, T>& reference) {
  return kernel::dot(reference, incident) < T{0} ? n : kernel::negate(n);
}

template <int length, typename T>
inline glm::vec<length, T> reflect(const glm::vec<length, T>& incident, const glm::vec<length, T>& n) {
  return incident - n * (T{2} * kernel::dot(n, incident));
}

/// Zero on total internal reflection.
template <int length, typename T, typename Eta>
inline glm::vec<length, T> refract(const glm::vec<length, T>& incident, const glm::vec<length, T>& n, Eta any_eta) {
  const T eta = static_cast<T>(any_eta);
  const T cosine = kernel::dot(n, incident);
  const T k = T{1} - eta * (eta * (T{1} - cosine * cosine));
  if (k < T{0}) return glm::vec<length, T>(T{0});
  return incident * eta - n * (eta * cosine + kernel::sqrt(k));
}

template <typename T>
inline T face_forward(T n, T incident, T reference) {
  return reference * incident < T{0} ? n : -n;
}
template <typename T>
inline T reflect(T incident, T n) {
  return incident - n * (T{2} * (n * incident));
}
template <typename T, typename Eta>
inline T refract(T incident, T n, Eta eta) {
  return kernel::refract(glm::vec<1, T>(incident), glm::vec<1, T>(n), eta).x;
}

}  // namespace tandem::kernel
