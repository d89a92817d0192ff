#pragma once

#include "rhi_cpu/kernel/trace.hpp"

/// Packets by their rays, for what no tracer can do with a whole packet.
namespace tandem::cpu {

kernel::Ray ray_of(const kernel::RayPacket& rays, std::uint32_t i);
void set_hit(kernel::HitPacket& hits, std::uint32_t i, const kernel::Hit& hit);

/// As TraceFunctions says, one ray after the other.
std::uint32_t closest_by_ray(const kernel::TopLevel& scene, const kernel::RayPacket& rays, kernel::HitPacket& hits);
std::uint32_t occluded_by_ray(const kernel::TopLevel& scene, const kernel::RayPacket& rays);

}  // namespace tandem::cpu
