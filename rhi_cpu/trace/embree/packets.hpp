#pragma once

#include "rhi_cpu/kernel/trace.hpp"

namespace tandem::cpu {

/// kernel::TraceFunctions::closest_of_packet and occluded_of_packet in one traversal of Embree, but for rays that a
/// filter has to look at.
std::uint32_t closest_of_packet(const kernel::TopLevel& scene, const kernel::RayPacket& rays, kernel::HitPacket& hits);
std::uint32_t occluded_of_packet(const kernel::TopLevel& scene, const kernel::RayPacket& rays);

}  // namespace tandem::cpu
