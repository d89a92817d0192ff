#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "compare/probe/instance_setup.hpp"
#include "rhi/device.hpp"

namespace tandem::compare {

/// Bits of a ray's flags. Vulkan and GLSL: gl_RayFlags*EXT.
namespace ray_flag {
inline constexpr std::uint32_t none = 0;
inline constexpr std::uint32_t opaque = 0x01;
inline constexpr std::uint32_t no_opaque = 0x02;
inline constexpr std::uint32_t terminate_on_first_hit = 0x04;
inline constexpr std::uint32_t cull_back_faces = 0x10;
inline constexpr std::uint32_t cull_front_faces = 0x20;
inline constexpr std::uint32_t cull_opaque = 0x40;
inline constexpr std::uint32_t cull_no_opaque = 0x80;
inline constexpr std::uint32_t skip_triangles = 0x100;
inline constexpr std::uint32_t skip_boxes = 0x200;
}  // namespace ray_flag

/// Which part of a ray is asked, seen from what it first meets there.
enum class Window {
  whole,         ///< all of the ray
  from_before,   ///< t_min a little in front of the first hit, which still counts
  from_behind,   ///< t_min a little behind it: the second hit
  until_before,  ///< t_max a little in front of it: nothing
  until_behind   ///< t_max a little behind it, which still counts
};

inline constexpr std::uint32_t each_in_turn = ~std::uint32_t{0};
inline constexpr std::uint32_t accept_all = ~std::uint32_t{0};
inline constexpr std::uint32_t accept_half = accept_all / 2;

/// One way of asking: the same rays, moved along with the instance that they are aimed at.
struct Trial {
  const char* name = "";
  InstanceSetup instance_setup = InstanceSetup::plain;
  std::uint32_t target = 0;  ///< the placement that rays are aimed at, or each_in_turn
  std::uint32_t flags = ray_flag::none;
  std::uint32_t mask = 0xff;
  std::uint32_t acceptance = accept_all;  ///< a candidate that is not opaque counts if its hash is at most this
  Window window = Window::whole;
  bool any_hit = false;  ///< it is left open which hit is committed: only whether there is one counts
};

/// Every trial, in the order in which they are made.
std::span<const Trial> trials();

/// Whether the hash of a candidate that is not opaque is at most `acceptance`: is_accepted of shaders/probe/trial.glsl.
bool is_accepted(std::uint32_t geometry, std::uint32_t primitive, std::uint32_t acceptance);

}  // namespace tandem::compare
