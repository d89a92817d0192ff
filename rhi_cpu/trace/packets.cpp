#include "rhi_cpu/trace/packets.hpp"

namespace tandem::cpu {

kernel::Ray ray_of(const kernel::RayPacket& rays, std::uint32_t i) {
  return {.origin = {rays.origin[0][i], rays.origin[1][i], rays.origin[2][i]},
          .t_min = rays.t_min[i],
          .direction = {rays.direction[0][i], rays.direction[1][i], rays.direction[2][i]},
          .t_max = rays.t_max[i],
          .flags = rays.flags,
          .mask = rays.mask};
}

void set_hit(kernel::HitPacket& hits, std::uint32_t i, const kernel::Hit& hit) {
  hits.t[i] = hit.t;
  hits.barycentrics[0][i] = hit.barycentrics[0];
  hits.barycentrics[1][i] = hit.barycentrics[1];
  hits.instance_index[i] = hit.instance_index;
  hits.geometry_index[i] = hit.geometry_index;
  hits.primitive_index[i] = hit.primitive_index;
  hits.front_face = (hits.front_face & ~(1u << i)) | std::uint32_t{hit.front_face} << i;
}

std::uint32_t closest_by_ray(const kernel::TopLevel& scene, const kernel::RayPacket& rays, kernel::HitPacket& hits) {
  std::uint32_t found = 0;
  for (std::uint32_t i = 0; i < rays.count; ++i) {
    if ((rays.active >> i & 1) == 0) continue;
    kernel::Hit hit;
    if (!scene.functions->closest(scene, ray_of(rays, i), hit)) continue;
    set_hit(hits, i, hit);
    found |= 1u << i;
  }
  return found;
}

std::uint32_t occluded_by_ray(const kernel::TopLevel& scene, const kernel::RayPacket& rays) {
  std::uint32_t found = 0;
  for (std::uint32_t i = 0; i < rays.count; ++i)
    if ((rays.active >> i & 1) != 0 && scene.functions->occluded(scene, ray_of(rays, i))) found |= 1u << i;
  return found;
}

}  // namespace tandem::cpu
