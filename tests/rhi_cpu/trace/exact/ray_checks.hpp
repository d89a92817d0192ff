#pragma once

#include <cstdint>
#include <vector>

#include "rhi_cpu/kernel/trace.hpp"
#include "tests/rhi_cpu/trace/exact/rational_tracer.hpp"

namespace tandem::test {

/// Traces the ray by each of the trace functions and checks that the answers are those of `expected`, all_hits of the
/// ray, to the last bit: there is no tolerance.
void check_ray(const kernel::TopLevel& scene, const kernel::Ray& ray, const std::vector<kernel::Hit>& expected);

/// check_ray with every hit that the scene has for the ray.
/// @return their number
std::size_t check_ray(const RationalScene& scene, const kernel::TopLevel& built, const kernel::Ray& ray);

}  // namespace tandem::test
