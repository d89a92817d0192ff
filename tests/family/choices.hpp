#pragma once

#include <cstdint>
#include <initializer_list>
#include <random>
#include <vector>

namespace tandem::family {

/// Random decisions, the same for the same seed on every machine.
class Choices {
 public:
  explicit Choices(std::uint32_t seed) : random_(seed) {}
  /// In [0, count).
  int below(int count) { return static_cast<int>(random_() % static_cast<std::uint32_t>(count)); }
  /// In [first, last].
  int between(int first, int last) { return first + below(last - first + 1); }
  bool chance(int percent) { return below(100) < percent; }
  std::uint32_t word() { return static_cast<std::uint32_t>(random_()); }
  template <typename T>
  T of(std::initializer_list<T> values) {
    return *(values.begin() + below(static_cast<int>(values.size())));
  }
  template <typename T>
  const T& of(const std::vector<T>& values) {
    return values[static_cast<std::size_t>(below(static_cast<int>(values.size())))];
  }

 private:
  std::mt19937 random_;
};

}  // namespace tandem::family
