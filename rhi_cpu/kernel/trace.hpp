#pragma once

#include <cstdint>

/// How a translated shader traces rays: through plain data and a table of functions, so that a kernel neither links nor
/// knows what is behind it (Embree, or the exact tracer).
namespace tandem::kernel {

/// Vulkan ray flags (SPIR-V RayFlags), the values that rayQueryInitializeEXT takes.
enum RayFlag : std::uint32_t {
  ray_flag_opaque = 0x01,
  ray_flag_no_opaque = 0x02,
  ray_flag_terminate_on_first_hit = 0x04,
  ray_flag_skip_closest_hit_shader = 0x08,
  ray_flag_cull_back_facing_triangles = 0x10,
  ray_flag_cull_front_facing_triangles = 0x20,
  ray_flag_cull_opaque = 0x40,
  ray_flag_cull_no_opaque = 0x80,
  ray_flag_skip_triangles = 0x100,
  ray_flag_skip_aabbs = 0x200
};

/// A ray in world space, as rayQueryInitializeEXT receives it. A triangle is hit at t_min < t < t_max, both ends
/// excluded (Vulkan specification, "Ray Intersection Candidate Determination").
struct alignas(16) Ray {
  float origin[3];
  float t_min;
  float direction[3];  ///< not normalised: t counts in its lengths
  float t_max;
  std::uint32_t flags;
  std::uint32_t mask;  ///< 8 bits
};

/// Four floats. A ray travels as two of them, because Embree loads it so: a vector load that follows
/// scalar stores waits for them, which costs a tenth of a simple ray.
using FloatVector = float __attribute__((vector_size(16)));

struct RayVectors {
  FloatVector origin;     ///< and t_min
  FloatVector direction;  ///< and t_max
  std::uint32_t flags;
  std::uint32_t mask;
};
static_assert(sizeof(RayVectors) == sizeof(Ray));

/// A triangle or a box that a ray meets.
struct Hit {
  float t;                       ///< of a box: where the ray enters it, or t_min where it begins inside
  float barycentrics[2];         ///< of a triangle: weights of the second and third vertex
  std::uint32_t instance_index;  ///< position in the top level's instance buffer: gl_InstanceID
  std::uint32_t geometry_index;
  std::uint32_t primitive_index;
  bool front_face;  ///< of a triangle
  bool opaque;      ///< a triangle commits without the shader's confirmation; `closest` and `occluded` treat every so
  bool is_box;      ///< a candidate even when opaque: the shader finds the hit, if there is one
};

/// What becomes of a candidate.
enum class CandidateDecision : std::uint32_t { ignore, commit, commit_and_terminate };

/// Decides about candidates while a ray is traced: the any-hit and intersection shaders of a pipeline. It is called for
/// candidates in any order, at least once for every one that is nearer than the hit which is committed in the end, and
/// at most once for each.
struct CandidateVisitor {
  void* context;
  /// A triangle that is not opaque, with t_min < t < t_max, nearer than what is committed.
  CandidateDecision (*triangle)(void* context, const Hit& candidate);
  /// A box that the ray meets somewhere in [t_min, t_max], opaque or not; t_max is that of the hit committed so far. To
  /// commit, it sets candidate.t to the hit's, in [t_min, t_max].
  CandidateDecision (*box)(void* context, Hit& candidate, float t_max);
  /// `triangle` is asked about opaque triangles too, instead of their being committed: their hit group may be one for
  /// boxes. Hit::opaque says which they are.
  bool visits_opaque_triangles = false;
};

/// What the getters of a hit need of its instance.
struct Instance {
  float object_to_world[3][4];  ///< row-major
  float world_to_object[3][4];
  std::uint32_t custom_index;
  std::uint32_t sbt_offset;
};

/// The most rays of a packet.
inline constexpr std::uint32_t packet_capacity = 16;

/// Rays that are traced together, with the same flags and mask. Those whose bit in `active` is not set are not looked
/// at.
struct alignas(64) RayPacket {
  float origin[3][packet_capacity];
  float t_min[packet_capacity];
  float direction[3][packet_capacity];
  float t_max[packet_capacity];
  std::uint32_t active;  ///< bit i: ray i is traced
  std::uint32_t count;   ///< 4, 8 or 16: rays beyond it are not active
  std::uint32_t flags;
  std::uint32_t mask;
};

/// The hits of a packet's rays, of those that hit something.
struct alignas(64) HitPacket {
  float t[packet_capacity];
  float barycentrics[2][packet_capacity];
  std::uint32_t instance_index[packet_capacity];
  std::uint32_t geometry_index[packet_capacity];
  std::uint32_t primitive_index[packet_capacity];
  std::uint32_t front_face;  ///< bit i: of ray i
};

struct TopLevel;

/// All of them leave out what the ray's mask and flags cull (among them ray_flag_skip_triangles and
/// ray_flag_skip_aabbs), expect a ray with t_min < t_max, and are thread-safe.
struct TraceFunctions {
  /// The closest triangle, opaque or not; it counts as opaque. Boxes are not looked at.
  bool (*closest)(const TopLevel& scene, const Ray& ray, Hit& hit);
  /// Whether there is any triangle, opaque or not. Boxes are not looked at.
  bool (*occluded)(const TopLevel& scene, const Ray& ray);
  /// The first hits, at most `capacity`, after `previous`, or the first of all when it is null, in the total order (t,
  /// instance, geometry, primitive), opaque or not, triangles and boxes. Fewer than `capacity`: there are no more after
  /// them, or the last of them is an opaque triangle, behind which nothing can be committed. Repeated with the last one
  /// as `previous`, it enumerates every triangle and box that the ray meets exactly once, also those of equal t.
  std::uint32_t (*next_hits)(const TopLevel& scene, const Ray& ray, const Hit* previous, Hit* hits,
                             std::uint32_t capacity);
  /// The closest of the opaque triangles and of what `visitor` commits; with ray_flag_terminate_on_first_hit any of
  /// them. False when there is none.
  bool (*visit)(const TopLevel& scene, const Ray& ray, const CandidateVisitor& visitor, Hit& committed);
  /// `closest` and `occluded` of the rays of a packet. The bits of those that hit something are set in the result. Of
  /// two triangles at the same distance a packet may find another one than a ray does.
  std::uint32_t (*closest_of_packet)(const TopLevel& scene, const RayPacket& rays, HitPacket& hits);
  std::uint32_t (*occluded_of_packet)(const TopLevel& scene, const RayPacket& rays);
};

/// A built top level as a kernel sees it; the backend derives its own from it. An acceleration structure's Resource
/// points at one.
struct TopLevel {
  const TraceFunctions* functions;
  const Instance* instances;
  std::uint32_t instance_count;
  bool all_opaque;  ///< no triangle is a candidate unless the ray has ray_flag_no_opaque
  bool has_boxes;   ///< some instance holds boxes, which are always candidates
};

/// Whether a ray with these flags could meet anything that needs the shader's decision. When it cannot, `closest` and
/// `occluded` are all that it takes.
inline bool can_meet_candidates(const TopLevel& scene, std::uint32_t flags) {
  if (scene.has_boxes && (flags & ray_flag_skip_aabbs) == 0) return true;
  if ((flags & (ray_flag_opaque | ray_flag_cull_no_opaque | ray_flag_skip_triangles)) != 0) return false;
  return (flags & ray_flag_no_opaque) != 0 || !scene.all_opaque;
}

/// What the device address of a top level points at: the structure as it was built last, or null.
struct AddressedTopLevel {
  const TopLevel* top_level = nullptr;
};

}  // namespace tandem::kernel
