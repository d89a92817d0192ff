#pragma once

#include <optional>

#include "rhi_cpu/kernel/trace.hpp"
#include "rhi_cpu/trace/exact/transform.hpp"
#include "rhi_cpu/trace/geometry_input.hpp"

namespace tandem::cpu::exact {

/// The first t in [t_min, t_max] at which the ray is inside of the box or on its surface, rounded to the nearest float;
/// nothing when there is none.
/// @param box finite, its minimum not above its maximum
/// @param transform can be inverted
std::optional<float> entry_of(const kernel::Ray& ray, const Transform& transform, const Box& box);

}  // namespace tandem::cpu::exact
