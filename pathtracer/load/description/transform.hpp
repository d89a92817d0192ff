#pragma once

#include <glm/mat4x4.hpp>

#include "base/json_value.hpp"
#include "pathtracer/load/description/ranges.hpp"

namespace tandem::pathtracer::description {

/// An affine map that can be inverted: a list of {"translate": [x, y, z]}, {"rotate": degrees, "axis": [x, y, z]} and
/// {"scale": s or [x, y, z]}, applied in this order; or the three or four rows of a matrix. Throws Error.
/// @param exact numbers are as written, not rounded to floats
glm::dmat4 read_transform(const Value& value, bool exact);

}  // namespace tandem::pathtracer::description
