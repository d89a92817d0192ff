#include "pathtracer/load/description/transform.hpp"

#include <cmath>

#include <glm/gtc/matrix_transform.hpp>

namespace tandem::pathtracer::description {
namespace {

double number_of(const Value& value, bool exact) {
  return exact ? value.double_number(any_length) : double{value.number(any_length)};
}

glm::dvec3 vector_of(const Value& value, bool exact) {
  return exact ? value.double_vector(any_length) : glm::dvec3(value.vector(any_length));
}

glm::dmat4 read_step(const Value& value, bool exact) {
  const Object step(value, {"translate", "rotate", "axis", "scale"});
  const glm::dmat4 identity(1.0);
  const std::optional<Value> translate = step.get("translate");
  const std::optional<Value> rotate = step.get("rotate");
  const std::optional<Value> scale = step.get("scale");
  if (int{translate.has_value()} + int{rotate.has_value()} + int{scale.has_value()} != 1)
    value.fail("must have one of: translate, rotate, scale");
  if (rotate.has_value() != step.get("axis").has_value()) value.fail("must have an axis with rotate, and only then");
  if (translate) return glm::translate(identity, vector_of(*translate, exact));
  if (scale)
    return glm::scale(identity, scale->is_array() ? vector_of(*scale, exact) : glm::dvec3(number_of(*scale, exact)));
  const Value direction = step.require("axis");
  direction.direction(any_length);  // which is not 0
  return glm::rotate(identity, glm::radians(number_of(*rotate, exact)), glm::normalize(vector_of(direction, exact)));
}

glm::dmat4 read_matrix(const Value& value, const std::vector<Value>& rows, bool exact) {
  if (rows.size() != 3 && rows.size() != 4) value.fail("must have 3 or 4 rows");
  glm::dmat4 matrix(1.0);
  for (int row = 0; row < static_cast<int>(rows.size()); ++row) {
    const std::vector<Value> columns = rows[static_cast<std::size_t>(row)].elements(4);
    for (int column = 0; column < 4; ++column) {
      const Value& element = columns[static_cast<std::size_t>(column)];
      const double required = column == 3 ? 1 : 0;
      matrix[column][row] = number_of(element, exact);
      if (row == 3 && matrix[column][row] != required) element.fail(fmt::format("must be {}", required));
    }
  }
  return matrix;
}

}  // namespace

glm::dmat4 read_transform(const Value& value, bool exact) {
  const std::vector<Value> elements = value.elements();
  glm::dmat4 transform(1.0);
  if (!elements.empty() && elements.front().is_array())
    transform = read_matrix(value, elements, exact);
  else
    for (const Value& step : elements) transform = read_step(step, exact) * transform;
  const double volume = glm::determinant(glm::dmat3(transform));
  if (!(std::abs(volume) > 0) || !std::isfinite(volume)) value.fail("must not flatten what it transforms");
  return transform;
}

}  // namespace tandem::pathtracer::description
