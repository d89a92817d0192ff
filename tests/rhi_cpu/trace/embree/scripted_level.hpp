#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "rhi_cpu/kernel/ray_query.hpp"

namespace tandem::test {

/// A top level whose hits are a script, and that counts what it is asked.
struct ScriptedLevel : kernel::TopLevel {
  std::vector<kernel::Hit> hits;  // in the order of t, each with a primitive index of its own
  mutable int closest_calls = 0;
  mutable int occluded_calls = 0;
  mutable int next_calls = 0;
  mutable kernel::Ray last_ray = {};
  std::array<kernel::Instance, 2> scripted_instances = {
      kernel::Instance{.object_to_world = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}},
                       .world_to_object = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}},
                       .custom_index = 11,
                       .sbt_offset = 21},
      kernel::Instance{.object_to_world = {{2, 0, 0, 10}, {0, 0, -4, 20}, {0, 8, 0, 30}},
                       .world_to_object = {{0.5f, 0, 0, -5}, {0, 0, 0.125f, -3.75f}, {0, -0.25f, 0, 5}},
                       .custom_index = 0xABCDEF,
                       .sbt_offset = 22}};

  explicit ScriptedLevel(std::vector<kernel::Hit> script) : kernel::TopLevel{}, hits(std::move(script)) {
    functions = &scripted_functions;
    instances = scripted_instances.data();
    instance_count = static_cast<std::uint32_t>(scripted_instances.size());
    all_opaque = true;
    has_boxes = false;
    for (const kernel::Hit& hit : hits) {
      all_opaque = all_opaque && (hit.opaque || hit.is_box);
      has_boxes = has_boxes || hit.is_box;
    }
  }
  ScriptedLevel(const ScriptedLevel&) = delete;
  ScriptedLevel& operator=(const ScriptedLevel&) = delete;

  kernel::accelerationStructureEXT handle() const { return {this}; }

  static const ScriptedLevel& of(const kernel::TopLevel& level) { return static_cast<const ScriptedLevel&>(level); }

  static bool closest(const kernel::TopLevel& level, const kernel::Ray& ray, kernel::Hit& hit) {
    ++of(level).closest_calls;
    of(level).last_ray = ray;
    for (const kernel::Hit& each : of(level).hits) {
      if (each.is_box) continue;
      hit = each;
      return true;
    }
    return false;
  }
  static bool occluded(const kernel::TopLevel& level, const kernel::Ray& ray) {
    ++of(level).occluded_calls;
    of(level).last_ray = ray;
    return std::any_of(of(level).hits.begin(), of(level).hits.end(), [](const auto& hit) { return !hit.is_box; });
  }
  static std::uint32_t next_hits(const kernel::TopLevel& level, const kernel::Ray& ray, const kernel::Hit* previous,
                                 kernel::Hit* hits, std::uint32_t capacity) {
    ++of(level).next_calls;
    of(level).last_ray = ray;
    std::uint32_t count = 0;
    bool is_behind = previous == nullptr;
    for (const kernel::Hit& candidate : of(level).hits) {
      if (is_behind && count < capacity) hits[count++] = candidate;
      if (previous != nullptr && candidate.primitive_index == previous->primitive_index) is_behind = true;
    }
    return count;
  }
  static constexpr kernel::TraceFunctions scripted_functions = {&closest, &occluded, &next_hits,
                                                                nullptr,  nullptr,   nullptr};
};

inline kernel::Hit triangle(float t, std::uint32_t primitive, bool opaque) {
  return {.t = t,
          .barycentrics = {0.25f, 0.5f},
          .instance_index = 1,
          .geometry_index = 3,
          .primitive_index = primitive,
          .front_face = true,
          .opaque = opaque,
          .is_box = false};
}

/// The ray enters it at `t`.
inline kernel::Hit box(float t, std::uint32_t primitive, bool opaque = false) {
  return {.t = t,
          .barycentrics = {0, 0},
          .instance_index = 1,
          .geometry_index = 4,
          .primitive_index = primitive,
          .front_face = false,
          .opaque = opaque,
          .is_box = true};
}

/// From (1, 2, 3) along (4, 5, 6), between 0.5 and 100.
inline void initialize(kernel::rayQueryEXT& query, const ScriptedLevel& level, std::uint32_t flags = 0) {
  rayQueryInitializeEXT(query, level.handle(), flags, 0xFF, kernel::vec3(1, 2, 3), 0.5f, kernel::vec3(4, 5, 6), 100.0f);
}

}  // namespace tandem::test
