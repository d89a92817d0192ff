#pragma once

#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "conformance/pipeline/probe.hpp"

/// A scene in which every built-in of a hit has another value for each ray, and what those values are.
namespace tandem::conformance::pipeline {

/// What a shader that hears of ray i's hit must see. Floats are computed with doubles from the ray and the instance.
struct ExpectedHit {
  TracedRay ray;
  std::uint32_t launch_size = 0;  ///< rays of the scene
  std::uint32_t instance = 0;
  std::uint32_t custom_index = 0;
  std::uint32_t geometry = 0;
  std::uint32_t primitive = 0;
  bool front_face = true;
  Transform object_to_world = identity;
  glm::dmat3 world_to_object_linear = glm::dmat3(1);  ///< world_to_object(p) = this * (p - translation)
  glm::dvec3 translation = glm::dvec3(0);
  glm::dvec3 object_origin = glm::dvec3(0);
  glm::dvec3 object_direction = glm::dvec3(0);
  double t = 0;
  glm::dvec2 barycentrics = glm::dvec2(0);
};

/// Three instances of one bottom level: in place; rotated, scaled, sheared and moved; mirrored. It has two geometries,
/// with two and three primitives.
struct BuiltinScene {
  Scene scene = {};
  std::vector<ExpectedHit> hits = {};  ///< one for each ray; every primitive of every instance is met once
};

enum class PrimitiveKind { triangles, boxes };

/// For boxes, ExpectedHit::t, front_face and barycentrics mean nothing: a shader reports what it likes. The boxes
/// surround the points where the triangles are hit.
BuiltinScene builtin_scene(rhi::Device& device, PrimitiveKind kind, rhi::GeometryFlags flags);

/// The rays of all hits.
std::vector<TracedRay> rays_of(const BuiltinScene& scene);

}  // namespace tandem::conformance::pipeline
