#include <cmath>

#include <spirv_cross/GLSL.std.450.h>

#include "program/cause/environment.hpp"
#include "program/cause/permitted.hpp"

/// Determinant and MatrixInverse. Vulkan gives them no precision ("undefined precision" of what its tables do not
/// name); they are held against the formula of cofactors, so that an inverse with exchanged elements is found.
namespace tandem::program {
namespace {

using Ranges = std::span<const Range>;

/// A square matrix without a column and a row, column by column.
std::vector<Range> minor_of(Ranges matrix, std::size_t size, std::size_t column, std::size_t row) {
  std::vector<Range> rest;
  for (std::size_t c = 0; c < size; ++c)
    for (std::size_t r = 0; r < size; ++r)
      if (c != column && r != row) rest.push_back(matrix[c * size + r]);
  return rest;
}

Range determinant(const Rules& rules, Ranges matrix, std::size_t size) {
  if (size == 1) return matrix[0];
  std::vector<Range> firsts, cofactors;
  for (std::size_t column = 0; column < size; ++column) {
    const Range minor = determinant(rules, minor_of(matrix, size, column, 0), size - 1);
    firsts.push_back(matrix[column * size]);
    cofactors.push_back(column % 2 == 0 ? minor : negate(minor));
  }
  return dot(rules, firsts, cofactors);
}

/// The cofactor over the determinant, or times its reciprocal.
Range inverse(const Rules& rules, Ranges matrix, std::size_t size, std::size_t component) {
  const std::size_t column = component / size, row = component % size;
  const Range whole = determinant(rules, matrix, size);
  const Range minor = determinant(rules, minor_of(matrix, size, row, column), size - 1);
  const Range cofactor = (row + column) % 2 == 0 ? minor : negate(minor);
  const Range quotient = divide(rules, cofactor, whole);
  Range result = either(quotient, multiply(rules, cofactor, divide(rules, exactly(1), whole)));
  if (result.exact == 0) result.exact = 0;  // not -0, which is only the sign of the cofactor
  return inherited(result);
}

bool may_be_singular(const Rules& rules, const Scalars& matrix, std::size_t size) {
  std::vector<Range> ranges;
  for (const Scalar& each : matrix) ranges.push_back(operand(rules, real_of(each)));
  const Range whole = determinant(rules, ranges, size);
  return !whole.open && whole.low <= 0 && whole.high >= 0;
}

}  // namespace

std::optional<Permissions> permitted_glsl_matrices(const Call& call) {
  if (call.glsl != GLSLstd450Determinant && call.glsl != GLSLstd450MatrixInverse) return std::nullopt;
  const Scalars& matrix = call.operand(0);
  const auto size = static_cast<std::size_t>(std::lround(std::sqrt(static_cast<double>(matrix.size()))));
  Permissions permissions;
  for (std::size_t i = 0; i < call.result.size(); ++i) {
    const Scalar like = call.result_scalar(i);
    const Rules rules = rules_of(call.module, call.instruction, like.width);
    if (call.glsl == GLSLstd450Determinant) {
      permissions.push_back(computed(rules, like.width, matrix,
                                     [&](const Rules& r, Ranges all) { return inherited(determinant(r, all, size)); }));
    } else if (may_be_singular(rules, matrix, size)) {
      permissions.push_back(undefined(like, "the matrix is singular, or nearly"));
    } else {
      permissions.push_back(
          computed(rules, like.width, matrix, [&](const Rules& r, Ranges all) { return inverse(r, all, size, i); }));
    }
  }
  return permissions;
}

}  // namespace tandem::program
