#include "compare/probe/trial.hpp"

#include <array>

namespace tandem::compare {

std::span<const Trial> trials() {
  using enum InstanceSetup;
  static const Trial all[] = {
      {.name = "plain"},
      {.name = "terminate on first hit", .flags = ray_flag::terminate_on_first_hit, .any_hit = true},
      {.name = "back faces culled", .flags = ray_flag::cull_back_faces},
      {.name = "front faces culled", .flags = ray_flag::cull_front_faces},
      {.name = "opaque culled", .flags = ray_flag::cull_opaque},
      {.name = "non-opaque culled", .flags = ray_flag::cull_no_opaque},
      {.name = "all opaque", .flags = ray_flag::opaque, .acceptance = 0},
      {.name = "none opaque", .flags = ray_flag::no_opaque, .acceptance = accept_half},
      {.name = "triangles skipped", .flags = ray_flag::skip_triangles},
      {.name = "boxes skipped", .flags = ray_flag::skip_boxes},
      {.name = "candidates rejected", .acceptance = accept_half},
      {.name = "from before the hit", .window = Window::from_before},
      {.name = "from behind the hit", .window = Window::from_behind},
      {.name = "until before the hit", .window = Window::until_before},
      {.name = "until behind the hit", .window = Window::until_behind},
      {.name = "turned instance", .instance_setup = instances, .target = 1},
      {.name = "mirrored instance", .instance_setup = instances, .target = 2},
      {.name = "sheared instance", .instance_setup = instances, .target = 3},
      {.name = "mirrored, back faces culled",
       .instance_setup = instances,
       .target = 2,
       .flags = ray_flag::cull_back_faces},
      {.name = "instance mask", .instance_setup = instances, .target = each_in_turn, .mask = 0x98},
      {.name = "flipped facing", .instance_setup = instance_flags, .target = 0, .flags = ray_flag::cull_back_faces},
      {.name = "culling disabled", .instance_setup = instance_flags, .target = 1, .flags = ray_flag::cull_back_faces},
      {.name = "forced opaque", .instance_setup = instance_flags, .target = 2, .acceptance = 0},
      {.name = "forced non-opaque", .instance_setup = instance_flags, .target = 3, .acceptance = accept_half},
      {.name = "refitted bottom level", .instance_setup = refitted},
      {.name = "moved top level", .instance_setup = moved},
      {.name = "transform at build", .instance_setup = build_transform},
      {.name = "without indices", .instance_setup = without_indices},
      {.name = "compacted", .instance_setup = compacted},
  };
  return all;
}

bool is_accepted(std::uint32_t geometry, std::uint32_t primitive, std::uint32_t acceptance) {
  // pcg4d of shaders/random.glsl, its first word.
  std::array<std::uint32_t, 4> v = {geometry, primitive, 0, 0};
  for (std::uint32_t& word : v) word = word * 1664525u + 1013904223u;
  const auto mix = [&v] {
    v[0] += v[1] * v[3];
    v[1] += v[2] * v[0];
    v[2] += v[0] * v[1];
    v[3] += v[1] * v[2];
  };
  mix();
  for (std::uint32_t& word : v) word ^= word >> 16;
  mix();
  return v[0] <= acceptance;
}

}  // namespace tandem::compare
