#include "program/cause/environment.hpp"
#include "program/cause/permitted.hpp"

/// Sums of products: OpDot, "inherited from the sum of x[i] * y[i]", and the products of matrices, which the tables do
/// not name, likewise.
namespace tandem::program {
namespace {

/// Columns and rows of a matrix; a vector has one column.
std::pair<std::size_t, std::size_t> shape_of(const Call& call, std::size_t operand) {
  const Instruction& type = definition(call.module, definition(call.module, call.ids[operand]).type);
  const std::size_t columns = type.op == spv::OpTypeMatrix ? type.words[3] : 1;
  return {columns, call.operand(operand).size() / columns};
}

Permitted sum_of_products(const Call& call, std::size_t component, const Scalars& x, const Scalars& y) {
  Scalars operands = x;
  operands.insert(operands.end(), y.begin(), y.end());
  const std::uint32_t width = call.result[component].width;
  const std::size_t count = x.size();
  return computed(rules_of(call.module, call.instruction, width), width, operands,
                  [count](const Rules& rules, std::span<const Range> all) {
                    const Range sum = dot(rules, all.first(count), all.subspan(count));
                    return count == 1 ? sum : inherited(sum);
                  });
}

Scalars column_of(const Call& call, std::size_t operand, std::size_t column) {
  const std::size_t rows = shape_of(call, operand).second;
  const auto first = call.operand(operand).begin() + static_cast<std::ptrdiff_t>(column * rows);
  return {first, first + static_cast<std::ptrdiff_t>(rows)};
}

Scalars row_of(const Call& call, std::size_t operand, std::size_t row) {
  const auto [columns, rows] = shape_of(call, operand);
  Scalars result;
  for (std::size_t column = 0; column < columns; ++column) result.push_back(call.operand(operand)[column * rows + row]);
  return result;
}

Permissions matrix_product(const Call& call, std::size_t result_rows) {
  Permissions permissions;
  for (std::size_t i = 0; i < call.result.size(); ++i)
    permissions.push_back(
        sum_of_products(call, i, row_of(call, 0, i % result_rows), column_of(call, 1, i / result_rows)));
  return permissions;
}

}  // namespace

std::optional<Permissions> permitted_products(const Call& call) {
  Permissions permissions;
  switch (call.instruction.op) {
    case spv::OpDot:
      return Permissions{sum_of_products(call, 0, call.operand(0), call.operand(1))};
    case spv::OpMatrixTimesVector:
    case spv::OpMatrixTimesMatrix:
      return matrix_product(call, shape_of(call, 0).second);
    case spv::OpVectorTimesMatrix:
      for (std::size_t i = 0; i < call.result.size(); ++i)
        permissions.push_back(sum_of_products(call, i, call.operand(0), column_of(call, 1, i)));
      return permissions;
    case spv::OpOuterProduct:
      for (std::size_t i = 0; i < call.result.size(); ++i) {
        const std::size_t rows = call.operand(0).size();
        permissions.push_back(sum_of_products(call, i, {call.operand(0)[i % rows]}, {call.operand(1)[i / rows]}));
      }
      return permissions;
    default:
      return std::nullopt;
  }
}

}  // namespace tandem::program
