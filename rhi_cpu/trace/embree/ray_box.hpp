#pragma once

#include "rhi_cpu/kernel/trace.hpp"
#include "rhi_cpu/trace/geometry_input.hpp"

namespace tandem::cpu {

/// Whether the ray is in a box of the instance anywhere in [t_min, t_max], both ends and all faces included, and where
/// it enters it; t_min where it begins inside. In double precision, and in favour of the box by what rounding the ray
/// and the transform to single precision is worth, a few units in the last place: a ray that only touches the box meets
/// it, and it is entered a little early rather than late.
bool meets_box(const kernel::Ray& ray, const kernel::Instance& instance, const Box& box, float& t);

}  // namespace tandem::cpu
