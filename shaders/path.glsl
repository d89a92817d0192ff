// The integrator: unidirectional path tracing with next event estimation at every vertex whose BSDF has a density, and
// Russian roulette. Light that lamps send to such a vertex is what next event estimation samples, so emission that a
// path runs into counts only where that cannot: at the first hit and after a specular lobe.

#ifndef TANDEM_PATH
#define TANDEM_PATH

#include "bsdf/bsdf.glsl"
#include "camera/pinhole.glsl"
#include "camera/shutter.glsl"
#include "geometry/frame.glsl"
#include "geometry/surface.glsl"
#include "light/light.glsl"
#include "random.glsl"
#include "trace.glsl"

// Roulette begins at the vertex that this many segments lie before, and always leaves at least one path in twenty to
// die.
const uint ROULETTE_DEPTH = 3;
const float ROULETTE_SURVIVAL = 0.95;

// Below this a throughput can no longer change a sum, but would become subnormal.
const float NEGLIGIBLE_THROUGHPUT = 1e-30;

precise vec3 drop_negligible(vec3 v) {
  return vec3(v.x >= NEGLIGIBLE_THROUGHPUT ? v.x : 0.0, v.y >= NEGLIGIBLE_THROUGHPUT ? v.y : 0.0,
              v.z >= NEGLIGIBLE_THROUGHPUT ? v.z : 0.0);
}

/// Radiance that a light, chosen at random, sends by way of the surface to wo (unit, in the frame), over the density of
/// the choice. `depth` is that of the segment that ends at the surface.
precise vec3 direct_light(Surface surface, BsdfParameters parameters, uint primitive, Frame frame, vec3 wo,
                          RandomKey key, uint depth, inout uint ray_count) {
  LightSample light = sample_light(surface.position, random_bits(key, light_dimension(depth)), shutter_time(key));
  if (light.primitive == primitive || max_component(light.radiance) == 0.0) return vec3(0.0);
  if (!(det_dot(light.direction, surface.geometric_normal) > 0.0)) return vec3(0.0);
  precise vec3 wi = to_local(frame, light.direction);
  if (!(wi.z > 0.0)) return vec3(0.0);
  precise float weight = det_div(wi.z, light.density);
  if (!(weight < 1e30)) return vec3(0.0);

  precise vec3 from = offset_point(surface.position, surface.geometric_normal, surface.offset, light.direction);
  precise vec3 to = offset_point(light.target, light.target_normal, light.target_offset, -light.direction);
  if (from == to) return vec3(0.0);
  ray_count += 1;
  if (trace_occluded(from, to, key, shadow_dimension(depth))) return vec3(0.0);
  return bsdf_evaluate(parameters, wo, wi) * light.radiance * weight;
}

/// Whether a scattered direction is on the side of the true surface that its lobe says. Interpolated normals can send
/// it to the other.
bool on_its_side(Surface surface, BsdfSample scattered, vec3 direction) {
  precise float cosine = det_dot(direction, surface.geometric_normal);
  return (scattered.lobe & LOBE_TRANSMISSION) != 0 ? cosine < 0.0 : cosine > 0.0;
}

/// Radiance that arrives at the camera along one random path through a pixel. Adds the rays it traces to ray_count.
precise vec3 path_radiance(uvec2 pixel, uint sample_index, inout uint ray_count) {
  RandomKey key;
  key.pixel = pixel.x + (pixel.y << 16);
  key.sample_index = sample_index;
  key.seed = render.seed;
  uvec4 camera_bits = random_bits(key, DIMENSION_CAMERA);
  vec2 film = vec2(unit_interval(camera_bits.x), unit_interval(camera_bits.y));
  precise vec3 origin = render.camera_position;
  precise vec3 direction = pinhole_direction(pixel, film, render.resolution, render.camera_right, render.camera_up,
                                             render.camera_forward);
  precise vec3 radiance = vec3(0.0);
  precise vec3 throughput = vec3(1.0);
  precise float squeezing = 1.0;  // the product of eta^2 since the camera; the throughput holds its inverse
  bool count_emission = true;

  for (uint depth = 0; depth < render.max_depth; ++depth) {
    ray_count += 1;
    uint primitive = trace_closest(origin, direction, key, segment_dimension(depth));
    if (primitive == NO_PRIMITIVE) {
      radiance += throughput * render.background;
      break;
    }
    Surface surface = surface_at(primitive, origin, direction, shutter_time(key));
    if (count_emission) radiance += throughput * materials[surface.material].emission;
    if (depth + 1 == render.max_depth) break;

    Frame frame = make_frame(surface.shading_normal);
    precise vec3 wo = to_local(frame, -direction);
    BsdfParameters parameters =
        bsdf_parameters(surface.material, surface.outside, surface.texture_coordinates, surface.position);
    bool has_density = bsdf_has_density(parameters);
    if (has_density && render.light_count != 0) {
      radiance += throughput * direct_light(surface, parameters, primitive, frame, wo, key, depth, ray_count);
    }

    uvec4 bits = random_bits(key, scattering_dimension(depth));
    vec3 u = vec3(unit_interval(bits.x), unit_interval(bits.y), unit_interval(bits.z));
    BsdfSample scattered = bsdf_sample(parameters, wo, u);
    precise vec3 next_direction = to_world(frame, scattered.direction);
    if (!on_its_side(surface, scattered, next_direction)) {
      // A density just loses this part of its lobe; a specular lobe would lose all, so there the geometric normal
      // decides.
      if (has_density) break;
      frame = make_frame(surface.geometric_normal);
      scattered = bsdf_sample(parameters, to_local(frame, -direction), u);
      next_direction = to_world(frame, scattered.direction);
      if (!on_its_side(surface, scattered, next_direction)) break;
    }

    throughput = drop_negligible(throughput * scattered.weight);
    if (max_component(throughput) == 0.0) break;
    squeezing *= scattered.eta * scattered.eta;
    if (depth >= ROULETTE_DEPTH) {
      precise float survival = max_component(throughput) * squeezing;
      survival = survival < ROULETTE_SURVIVAL ? survival : ROULETTE_SURVIVAL;
      if (unit_interval(bits.w) >= survival) break;
      throughput *= det_div(1.0, survival);
    }
    origin = offset_point(surface.position, surface.geometric_normal, surface.offset, next_direction);
    direction = next_direction;
    count_emission = (scattered.lobe & LOBE_SPECULAR) != 0;
  }
  return radiance;
}

#endif
