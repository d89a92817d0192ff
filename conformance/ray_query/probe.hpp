#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <string_view>
#include <vector>

#include "conformance/kit/context.hpp"
#include "conformance/kit/ray_flags.hpp"
#include "conformance/kit/scene.hpp"

/// One shader that traces rays with ray queries and records everything that it can ask of them. What it does with
/// candidates is data, so that most cases share it.
namespace tandem::conformance {

/// gl_RayQueryCandidateIntersection*EXT
namespace candidate_type {
inline constexpr std::uint32_t triangle = 0;
inline constexpr std::uint32_t box = 1;
}  // namespace candidate_type

/// gl_RayQueryCommittedIntersection*EXT
namespace committed_type {
inline constexpr std::uint32_t none = 0;
inline constexpr std::uint32_t triangle = 1;
inline constexpr std::uint32_t generated = 2;
}  // namespace committed_type

/// What is done with a candidate, in this order. Bits.
namespace action {
inline constexpr std::uint32_t skip = 0;
inline constexpr std::uint32_t confirm = 1;          ///< triangles only
inline constexpr std::uint32_t generate = 2;         ///< boxes only, at Decision::t unless what is committed is nearer
inline constexpr std::uint32_t generate_second = 4;  ///< after that, another at Decision::second_t
inline constexpr std::uint32_t terminate = 8;
}  // namespace action

inline constexpr std::uint32_t any = ~std::uint32_t{0};

/// What to do with the candidates that have these ids.
struct Decision {
  std::uint32_t actions = action::skip;
  std::uint32_t instance = any;
  std::uint32_t geometry = any;
  std::uint32_t primitive = any;
  float t = 0;
  float second_t = 0;
  std::array<std::uint32_t, 2> padding = {};
};
static_assert(sizeof(Decision) == 32);

struct Ray {
  glm::vec3 origin = {0.25f, 0.25f, 5};
  float t_min = 0;
  glm::vec3 direction = {0, 0, -1};
  float t_max = 100;
  std::uint32_t flags = ray_flags::none;
  std::uint32_t mask = 0xff;
  std::vector<Decision> decisions = {};  ///< the first that fits a candidate counts; it is skipped when none does
};

/// What the getters say of a candidate or of the committed intersection. Members that a getter is not defined for
/// (those of triangles for boxes, all but the type without a hit) are 0.
struct Intersection {
  std::uint32_t type = 0;
  std::uint32_t instance = 0;
  std::uint32_t custom_index = 0;
  std::uint32_t sbt_offset = 0;
  std::uint32_t geometry = 0;
  std::uint32_t primitive = 0;
  std::uint32_t front_face = 0;
  std::uint32_t box_opaque = 0;  ///< candidate boxes only
  float t = 0;                   ///< not of candidate boxes, which have none
  glm::vec2 barycentrics = {};
  std::uint32_t committed_type_after = 0;  ///< candidates only: what is committed once it has been decided on
  glm::vec3 object_origin = {};
  float committed_t_after = 0;
  glm::vec3 object_direction = {};
  std::uint32_t padding = 0;
  Transform object_to_world = {};
  Transform world_to_object = {};
};
static_assert(sizeof(Intersection) == 176);

/// What one ray met.
struct Traversal {
  glm::vec3 world_origin = {};  ///< rayQueryGetWorldRayOriginEXT, likewise the next ones
  float t_min = 0;
  glm::vec3 world_direction = {};
  std::uint32_t flags = 0;
  Intersection committed = {};
  std::uint32_t candidate_count = 0;
  std::vector<Intersection> candidates = {};  ///< the first most_candidates, in the order in which they were offered

  bool hit() const noexcept { return committed.type != committed_type::none; }
};

inline constexpr std::uint32_t most_candidates = 12;

/// Which primitive.
struct Ids {
  std::uint32_t instance = 0;
  std::uint32_t geometry = 0;
  std::uint32_t primitive = 0;
};

/// Throws Failure unless nothing is committed. `what` names the ray.
void check_miss(std::string_view what, const Traversal& traversal);
/// Throws Failure unless this triangle is committed at `t`.
void check_triangle(std::string_view what, const Traversal& traversal, const Ids& ids, double t);
/// Throws Failure unless an intersection of this box is committed at exactly `t`.
void check_generated(std::string_view what, const Traversal& traversal, const Ids& ids, float t);

/// Traces the rays, one invocation each.
std::vector<Traversal> trace(Context& context, const rhi::AccelerationStructureHandle& top_level,
                             const std::vector<Ray>& rays);
Traversal trace(Context& context, const rhi::AccelerationStructureHandle& top_level, const Ray& ray);

}  // namespace tandem::conformance
