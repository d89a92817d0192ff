#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "conformance/kit/ray_flags.hpp"
#include "conformance/pipeline/program.hpp"

/// Shaders that report every built-in of a ray and its hit: most cases are data for them. Bindings: 0 the scene,
/// 1 rays, 2 reports, 3 decisions, 4 plans, 5 outcomes, 6 reports of intersection shaders.
namespace tandem::conformance::pipeline {

/// A traceRayEXT. Layout of the shaders' Ray, std430.
struct TracedRay {
  glm::vec3 origin = {0, 0, 5};
  float t_min = 0;
  glm::vec3 direction = {0, 0, -1};
  float t_max = 100;
  std::uint32_t flags = 0;
  std::uint32_t mask = 0xff;
  std::uint32_t record_offset = 0;
  std::uint32_t record_stride = 0;
  std::uint32_t miss_index = 0;
  std::uint32_t padding[3] = {};
};
static_assert(sizeof(TracedRay) == 64);

/// Report::shader.
namespace reporter {
inline constexpr std::uint32_t none = 0;
inline constexpr std::uint32_t miss = 1;
inline constexpr std::uint32_t closest_hit = 2;
inline constexpr std::uint32_t any_hit = 3;
inline constexpr std::uint32_t intersection = 4;
}  // namespace reporter

/// What a shader sees. Layout of the shaders' Report, std430: words only, so that it has no padding. As a payload it
/// has 368 bytes.
struct Report {
  std::uint32_t shader = reporter::none;  ///< which one wrote the rest
  std::uint32_t record = 0;               ///< the word in its shader record
  std::uint32_t launch_id[3] = {};
  std::uint32_t launch_size[3] = {};
  std::uint32_t primitive = 0;
  std::uint32_t instance = 0;
  std::uint32_t custom_index = 0;
  std::uint32_t geometry = 0;
  std::uint32_t hit_kind = 0;
  std::uint32_t flags = 0;
  float t_min = 0;
  float t_max = 0;
  float hit_t = 0;
  float attributes[8] = {};
  float world_origin[3] = {};
  float world_direction[3] = {};
  float object_origin[3] = {};
  float object_direction[3] = {};
  float object_to_world[12] = {};  ///< row-major 3x4, of gl_ObjectToWorldEXT
  float world_to_object[12] = {};
  float object_to_world_3x4[12] = {};  ///< row-major 3x4, of gl_ObjectToWorld3x4EXT
  float world_to_object_3x4[12] = {};
  std::uint32_t any_hits = 0;            ///< any-hit invocations of the ray
  std::uint32_t any_hit_primitives = 0;  ///< bit i: for primitive i
  std::uint32_t any_hit_records = 0;     ///< the words in their shader records, or-ed
};
static_assert(sizeof(Report) == 88 * 4);

/// What the any-hit probe does with a candidate, by its primitive; none given: accept.
enum class Decision : std::uint32_t { accept, ignore, terminate };

/// What the intersection probe reports for a box, by geometry * 16 + primitive. Attributes of report i: t, kind and the
/// index of each, see expected_attribute.
struct Plan {
  std::uint32_t count = 0;
  float t[4] = {};
  std::uint32_t kind[4] = {};
};

/// What came of a plan, by ray * 64 + geometry * 16 + primitive.
struct Outcome {
  std::uint32_t runs = 0;      ///< how often the intersection shader ran; it may more than once
  std::uint32_t accepted = 0;  ///< bit i: report i returned true
  float t_max[5] = {};         ///< gl_RayTmaxEXT before each report and after the last
};
inline constexpr std::size_t outcomes_per_ray = 64;

/// Attribute `index` of a hit that the intersection probe reports at t with that kind.
inline float expected_attribute(int index, float t, std::uint32_t kind) {
  return t * static_cast<float>(index + 1) + static_cast<float>(kind);
}

/// The shaders. Their records hold one word.
namespace probe {
extern const std::string ray_generation;  ///< ray i of the launch's x into report i
extern const std::string miss;
extern const std::string closest_hit;          ///< of triangles
extern const std::string any_hit;              ///< of triangles: counts, then does as decided
extern const std::string any_hit_report;       ///< of triangles: reports as a closest-hit shader does, and accepts
extern const std::string box_closest_hit;      ///< with eight floats as attributes
extern const std::string box_any_hit;          ///< as any_hit
extern const std::string box_any_hit_report;   ///< as any_hit_report
extern const std::string intersection;         ///< reports as planned, and writes the outcome
extern const std::string intersection_report;  ///< writes the report itself and reports no hit
}  // namespace probe

/// Records of shaders 0, 1, ... with the words first_word, first_word + 1, ...
rhi::ShaderRecords numbered_records(std::size_t count, std::uint32_t first_word);

/// What the probe's hit and miss records hold by default.
inline constexpr std::uint32_t first_hit_word = 1;
inline constexpr std::uint32_t first_miss_word = 1u << 16;

/// A pipeline of the probe's shaders, traced once.
struct Probe {
  std::vector<HitGroupText> hit_groups = {{.closest_hit = probe::closest_hit, .any_hit = probe::any_hit}};
  std::size_t miss_count = 1;
  rhi::AccelerationStructureHandle scene = {};
  std::vector<TracedRay> rays = {};
  std::vector<Decision> decisions = {};  ///< by primitive
  std::vector<Plan> plans = {};
  rhi::ShaderRecords hit = {};    ///< empty: one for each group, numbered from first_hit_word on
  rhi::ShaderRecords miss = {};   ///< empty: one for each shader, numbered from first_miss_word on
  rhi::TraceRaysDesc trace = {};  ///< the size is that of rays
};

struct ProbeResult {
  std::vector<Report> reports = {};        ///< one for each ray
  std::vector<Outcome> outcomes = {};      ///< outcomes_per_ray for each ray
  std::vector<Report> intersections = {};  ///< one for each ray, by probe::intersection_report
};

ProbeResult run(Context& context, const Probe& probe, const std::string& label);

}  // namespace tandem::conformance::pipeline
