#include "pathtracer/load/description/transform.hpp"

#include <cmath>

#include <glm/gtc/matrix_transform.hpp>

namespace tandem::pathtracer::description {
namespace {

glm::dmat4 read_step(const Value& value) {
  const Object step(value, {"translate", "rotate", "axis", "scale"});
  const glm::dmat4 identity(1.0);
  const std::optional<Value> translate = step.get("translate");
  const std::optional<Value> rotate = step.get("rotate");
  const std::optional<Value> scale = step.get("scale");
  if (int{translate.has_value()} + int{rotate.has_value()} + int{scale.has_value()} != 1)
    value.fail("must have one of: translate, rotate, scale");
  if (rotate.has_value() != step.get("axis").has_value()) value.fail("must have an axis with rotate, and only then");
  if (translate) return glm::translate(identity, glm::dvec3(translate->vector(any_length)));
  if (scale)
    return glm::scale(identity,
                      glm::dvec3(scale->is_array() ? scale->vector(any_length) : glm::vec3(scale->number(any_length))));
  const glm::dvec3 axis(step.require("axis").direction(any_length));
  return glm::rotate(identity, glm::radians(double{rotate->number(any_length)}), glm::normalize(axis));
}

glm::dmat4 read_matrix(const Value& value, const std::vector<Value>& rows) {
  if (rows.size() != 3 && rows.size() != 4) value.fail("must have 3 or 4 rows");
  glm::dmat4 matrix(1.0);
  for (int row = 0; row < static_cast<int>(rows.size()); ++row) {
    const std::vector<Value> columns = rows[static_cast<std::size_t>(row)].elements(4);
    for (int column = 0; column < 4; ++column) {
      const Value& element = columns[static_cast<std::size_t>(column)];
      const double required = column == 3 ? 1 : 0;
      matrix[column][row] = double{element.number(any_length)};
      if (row == 3 && matrix[column][row] != required) element.fail(fmt::format("must be {}", required));
    }
  }
  return matrix;
}

}  // namespace

glm::dmat4 read_transform(const Value& value) {
  const std::vector<Value> elements = value.elements();
  glm::dmat4 transform(1.0);
  if (!elements.empty() && elements.front().is_array())
    transform = read_matrix(value, elements);
  else
    for (const Value& step : elements) transform = read_step(step) * transform;
  const double volume = glm::determinant(glm::dmat3(transform));
  if (!(std::abs(volume) > 0) || !std::isfinite(volume)) value.fail("must not flatten what it transforms");
  return transform;
}

}  // namespace tandem::pathtracer::description
