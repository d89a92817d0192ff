#pragma once

#include <cstdint>

namespace tandem::conformance {

/// gl_RayFlags*EXT
namespace ray_flags {
inline constexpr std::uint32_t none = 0;
inline constexpr std::uint32_t opaque = 0x01;
inline constexpr std::uint32_t no_opaque = 0x02;
inline constexpr std::uint32_t terminate_on_first_hit = 0x04;
inline constexpr std::uint32_t skip_closest_hit_shader = 0x08;
inline constexpr std::uint32_t cull_back_facing = 0x10;
inline constexpr std::uint32_t cull_front_facing = 0x20;
inline constexpr std::uint32_t cull_opaque = 0x40;
inline constexpr std::uint32_t cull_no_opaque = 0x80;
inline constexpr std::uint32_t skip_triangles = 0x100;
inline constexpr std::uint32_t skip_boxes = 0x200;
}  // namespace ray_flags

}  // namespace tandem::conformance
