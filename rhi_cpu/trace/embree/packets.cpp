#include "rhi_cpu/trace/embree/packets.hpp"

#include <algorithm>
#include <bit>

#include "rhi_cpu/trace/embree/filter.hpp"
#include "rhi_cpu/trace/embree/triangle_on_ray.hpp"
#include "rhi_cpu/trace/embree/vertex_hit.hpp"
#include "rhi_cpu/trace/packets.hpp"

namespace tandem::cpu {
namespace {

/// Embree's packet of `count` rays.
template <int count>
struct Packet;
template <>
struct Packet<4> {
  using Ray = RTCRay4;
  using RayHit = RTCRayHit4;
};
template <>
struct Packet<8> {
  using Ray = RTCRay8;
  using RayHit = RTCRayHit8;
};
template <>
struct Packet<16> {
  using Ray = RTCRay16;
  using RayHit = RTCRayHit16;
};

template <int count>
void intersect_packet(const int* valid, RTCScene scene, typename Packet<count>::RayHit& rays) {
#if TANDEM_EMBREE_MAJOR >= 4
  if constexpr (count == 4) rtcIntersect4(valid, scene, &rays);
  if constexpr (count == 8) rtcIntersect8(valid, scene, &rays);
  if constexpr (count == 16) rtcIntersect16(valid, scene, &rays);
#else
  EmbreeContext context;
  rtcInitIntersectContext(&context);
  if constexpr (count == 4) rtcIntersect4(valid, scene, &context, &rays);
  if constexpr (count == 8) rtcIntersect8(valid, scene, &context, &rays);
  if constexpr (count == 16) rtcIntersect16(valid, scene, &context, &rays);
#endif
}

template <int count>
void occlude_packet(const int* valid, RTCScene scene, typename Packet<count>::Ray& rays) {
#if TANDEM_EMBREE_MAJOR >= 4
  if constexpr (count == 4) rtcOccluded4(valid, scene, &rays);
  if constexpr (count == 8) rtcOccluded8(valid, scene, &rays);
  if constexpr (count == 16) rtcOccluded16(valid, scene, &rays);
#else
  EmbreeContext context;
  rtcInitIntersectContext(&context);
  if constexpr (count == 4) rtcOccluded4(valid, scene, &context, &rays);
  if constexpr (count == 8) rtcOccluded8(valid, scene, &context, &rays);
  if constexpr (count == 16) rtcOccluded16(valid, scene, &context, &rays);
#endif
}

/// @param valid receives Embree's mask: all bits of a ray that it may be given, none of the others
/// @return the same as bits
template <int count, typename EmbreeRays>
std::uint32_t set_rays(const TopLevelScene& scene, const kernel::RayPacket& rays, EmbreeRays& to, int* valid) {
  std::uint32_t traced = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    const bool is_traced = (rays.active >> i & 1) != 0 && is_traceable(scene, scene.triangles, ray_of(rays, i));
    traced |= std::uint32_t{is_traced} << i;
    valid[i] = is_traced ? -1 : 0;
    to.tnear[i] = first_included(rays.t_min[i]);
    to.tfar[i] = last_included(rays.t_max[i]);
  }
  std::copy_n(rays.origin[0], count, to.org_x);
  std::copy_n(rays.origin[1], count, to.org_y);
  std::copy_n(rays.origin[2], count, to.org_z);
  std::copy_n(rays.direction[0], count, to.dir_x);
  std::copy_n(rays.direction[1], count, to.dir_y);
  std::copy_n(rays.direction[2], count, to.dir_z);
  std::fill_n(to.time, count, 0.0f);
  std::fill_n(to.mask, count, rays.mask);
  std::fill_n(to.id, count, 0u);
  std::fill_n(to.flags, count, 0u);
  return traced;
}

/// What `closest` makes of Embree's answer for one ray.
template <typename EmbreeRayHits>
bool take_hit(const TopLevelScene& scene, const kernel::RayPacket& rays, const EmbreeRayHits& from, std::uint32_t i,
              kernel::HitPacket& hits) {
  kernel::Hit hit;
  if (from.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID) {
    if (!find_vertex_hit(scene, ray_of(rays, i), hit)) return false;
    set_hit(hits, i, hit);
    return true;
  }
  hit.t = from.ray.tfar[i];
  hit.barycentrics[0] = from.hit.u[i];
  hit.barycentrics[1] = from.hit.v[i];
  hit.instance_index = instance_of(scene.triangles, from.hit.instID[0][i]);
  hit.geometry_index = from.hit.geomID[i];
  hit.primitive_index = from.hit.primID[i];
  if (has_no_barycentrics(hit)) [[unlikely]]
    restore_barycentrics(scene, ray_of(rays, i), hit);
  const float along[3] = {rays.direction[0][i], rays.direction[1][i], rays.direction[2][i]};
  float direction[3] = {along[0], along[1], along[2]};
  if (!scene.triangles.direct) {
    const auto& m = scene.instances[hit.instance_index].world_to_object;
    for (int row = 0; row < 3; ++row)
      direction[row] = m[row][0] * along[0] + m[row][1] * along[1] + m[row][2] * along[2];
  }
  hit.front_face = is_front_face(scene.traits[hit.instance_index],
                                 {from.hit.Ng_x[i], from.hit.Ng_y[i], from.hit.Ng_z[i]}, direction);
  set_hit(hits, i, hit);
  return true;
}

template <int count>
std::uint32_t closest_of(const TopLevelScene& scene, const kernel::RayPacket& rays, kernel::HitPacket& hits) {
  alignas(64) typename Packet<count>::RayHit query;
  alignas(64) int valid[count];
  const std::uint32_t traced = set_rays<count>(scene, rays, query.ray, valid);
  std::fill_n(query.hit.geomID, count, RTC_INVALID_GEOMETRY_ID);
  std::fill_n(query.hit.instID[0], count, RTC_INVALID_GEOMETRY_ID);
  intersect_packet<count>(valid, scene.triangles.scene, query);
  std::uint32_t found = 0;
  for (std::uint32_t rest = traced; rest != 0; rest &= rest - 1) {
    const auto i = static_cast<std::uint32_t>(std::countr_zero(rest));
    if (take_hit(scene, rays, query, i, hits)) found |= 1u << i;
  }
  return found;
}

template <int count>
std::uint32_t occluded_of(const TopLevelScene& scene, const kernel::RayPacket& rays) {
  alignas(64) typename Packet<count>::Ray query;
  alignas(64) int valid[count];
  std::uint32_t found = set_rays<count>(scene, rays, query, valid);
  occlude_packet<count>(valid, scene.triangles.scene, query);
  for (std::uint32_t i = 0; i < count; ++i)
    if (!(query.tfar[i] < 0)) found &= ~(1u << i);
  return found;
}

const TopLevelScene& scene_of(const kernel::TopLevel& top_level) {
  return static_cast<const TopLevelScene&>(top_level);
}

}  // namespace

std::uint32_t closest_of_packet(const kernel::TopLevel& top_level, const kernel::RayPacket& rays,
                                kernel::HitPacket& hits) {
  const TopLevelScene& scene = scene_of(top_level);
  if (std::has_single_bit(rays.active) || needs_filter(scene, rays.flags)) return closest_by_ray(scene, rays, hits);
  if (rays.count == 4) return closest_of<4>(scene, rays, hits);
  if (rays.count == 8) return closest_of<8>(scene, rays, hits);
  return closest_of<16>(scene, rays, hits);
}

std::uint32_t occluded_of_packet(const kernel::TopLevel& top_level, const kernel::RayPacket& rays) {
  const TopLevelScene& scene = scene_of(top_level);
  if (std::has_single_bit(rays.active) || needs_filter(scene, rays.flags)) return occluded_by_ray(scene, rays);
  if (rays.count == 4) return occluded_of<4>(scene, rays);
  if (rays.count == 8) return occluded_of<8>(scene, rays);
  return occluded_of<16>(scene, rays);
}

}  // namespace tandem::cpu
