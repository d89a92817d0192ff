#include "pathtracer/load/obj/obj_positions.hpp"

#include <fmt/format.h>

#include <cmath>

namespace tandem::pathtracer {
namespace {

/// The intersection of a ray with a triangle needs products of three coordinates, which must be finite floats.
constexpr double largest_coordinate = 1e12;

}  // namespace

void ObjPositions::add(const WavefrontText& text, const Statement& statement) {
  std::string_view rest = statement.rest;
  glm::dvec3 position(0);
  std::string problem;
  for (int axis = 0; axis < 3; ++axis) {
    const std::string_view word = take_word(rest);
    double value = 0;
    if (word.empty()) throw text.error("a vertex has fewer than three coordinates");
    if (!parse_number(word, value) || !std::isfinite(static_cast<float>(value)))
      problem = fmt::format("the vertex coordinate '{}' is not a finite number", word);
    else if (std::abs(value) > largest_coordinate)
      problem = fmt::format("the vertex coordinate '{}' is beyond {:g}, the farthest that rays reach", word,
                            largest_coordinate);
    position[axis] = value;
  }
  if (!problem.empty()) unusable_.emplace(static_cast<std::uint32_t>(positions_.size()), text.error(problem).what());
  positions_.push_back(position);
  int further = 0;
  for (std::string_view word = take_word(rest); !word.empty() && word[0] != '#'; word = take_word(rest)) ++further;
  has_colors_ = has_colors_ || further >= 3;
}

const glm::dvec3& ObjPositions::at(std::uint32_t index) const {
  if (const auto found = unusable_.find(index); found != unusable_.end()) throw Error(found->second);
  return positions_[index];
}

}  // namespace tandem::pathtracer
