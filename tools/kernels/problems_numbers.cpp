#include <algorithm>
#include <cmath>

#include "tools/kernels/problems.hpp"

namespace tandem::kernels {

Problem matrix_product(Size size) {
  const std::uint32_t n = size == Size::small ? 48 : 256;
  const std::vector<float> a = whole_floats(std::size_t{n} * n, 100, 1);
  const std::vector<float> b = whole_floats(std::size_t{n} * n, 100, 2);
  std::vector<float> c(std::size_t{n} * n, 0.0F);
  for (std::size_t row = 0; row < n; ++row)
    for (std::size_t k = 0; k < n; ++k)
      for (std::size_t column = 0; column < n; ++column) c[row * n + column] += a[row * n + k] * b[k * n + column];
  Problem problem{.inputs = {{.words = words_of(a)}, {.words = words_of(b)}},
                  .push_constants = {n},
                  .workgroup_count = {n / 16, n / 16, 1},
                  .floats = true};
  problem.expected.assign(c.begin(), c.end());
  return problem;
}

Problem n_body(Size size) {
  const std::uint32_t count = size == Size::small ? 512 : 4096;
  std::vector<float> bodies;
  for (std::uint32_t i = 0; i < count; ++i) {
    for (std::uint32_t axis = 0; axis < 3; ++axis) bodies.push_back(unit(4 * i + axis));
    bodies.push_back(0.5F * unit(4 * i + 3) + 1.0F);
  }
  Problem problem{.inputs = {{.words = words_of(bodies)}},
                  .push_constants = {count},
                  .workgroup_count = {count / 256, 1, 1},
                  .floats = true};
  double most = 0.0;
  for (std::size_t i = 0; i < bodies.size(); i += 4) {
    double sums[4] = {}, sizes = 0.0;
    for (std::size_t j = 0; j < bodies.size(); j += 4) {
      double squares = double{0.01F};
      for (std::size_t axis = 0; axis < 3; ++axis)
        squares += std::pow(double{bodies[j + axis]} - double{bodies[i + axis]}, 2);
      const double factor = double{bodies[j + 3]} / (squares * std::sqrt(squares));
      for (std::size_t axis = 0; axis < 3; ++axis)
        sums[axis] += (double{bodies[j + axis]} - double{bodies[i + axis]}) * factor;
      sizes += std::sqrt(squares) * factor;
    }
    problem.expected.insert(problem.expected.end(), std::begin(sums), std::end(sums));
    most = std::max(most, sizes);
  }
  // A term errs by some 16 roundings of its size (an inverse square root alone by 2 ulp, thrice), a sum of n terms by n
  // more of the sum of their sizes.
  problem.tolerance = (16.0 + count) * 0x1p-24 * most;
  return problem;
}

}  // namespace tandem::kernels
