// The integrator: unidirectional path tracing with next event estimation at every vertex that scatters by a density,
// weighted against the lights that scattered rays run into (multiple importance sampling), and Russian roulette.
// options.glsl says what of this can be changed.

#ifndef TANDEM_INTEGRATOR_PATH
#define TANDEM_INTEGRATOR_PATH

#include "camera/camera.glsl"
#include "integrator/direct_light.glsl"
#include "integrator/events.glsl"
#include "integrator/mis.glsl"
#include "integrator/options.glsl"
#include "integrator/vertex.glsl"
#include "light/light.glsl"
#include "sampling/sampler.glsl"
#include "trace.glsl"

// Roulette begins at the vertex that this many segments lie before, and always leaves at least one path in twenty to
// die.
const uint ROULETTE_DEPTH = 3;
const float ROULETTE_SURVIVAL = 0.95;

/// How the ray of a path came to be: what decides how much a light counts that it meets.
struct Origin {
  vec3 position;  // of the vertex that scattered it
  float density;  // per solid angle; 0 if next event estimation could not have found its direction
};

/// Radiance of a surface that the ray meets, weighted against next event estimation.
precise vec3 weighted_emission(Surface surface, uint primitive, Origin origin, vec3 direction, float time) {
  vec3 radiance = emitted_radiance(surface.material, surface.texture_coordinates, surface.position, surface.tint);
  if (max_component(radiance) == 0.0 || origin.density == 0.0) return radiance;
  float density =
      light_density(primitive, origin.position, direction, surface.position, surface.geometric_normal, time);
  return radiance * scattered_weight(origin.density, density);
}

/// Radiance from beyond the scene, likewise.
precise vec3 weighted_environment(Origin origin, vec3 direction) {
  vec3 radiance = environment_radiance(direction);
  if (!FEATURE_LIGHTS || origin.density == 0.0) return radiance;
  return radiance * scattered_weight(origin.density, environment_density(direction));
}

/// Radiance that arrives at the camera along one random path through a pixel. Adds the rays it traces to ray_count.
precise vec3 path_radiance(uvec2 pixel, uint sample_index, inout uint ray_count) {
  RandomKey key;
  key.pixel = pixel.x + (pixel.y << 16);
  key.sample_index = sample_index;
  key.seed = render.seed;
  precise float time = shutter_time(key);
  precise CameraRay camera = camera_ray(pixel, key, time);
  precise vec3 origin = camera.origin;
  precise vec3 direction = camera.direction;
  bool occlusion = option_integrator() == INTEGRATOR_AMBIENT_OCCLUSION;
  uint max_depth = occlusion ? 2 : render.max_depth;
  float ray_length = RAY_LENGTH;

  precise vec3 radiance = vec3(0.0);
  precise vec3 throughput = vec3(1.0);
  precise float eta_scale = 1.0;  // the product of eta^2 since the camera; the throughput holds its inverse
  uint medium = render.medium;
  precise Origin scatterer;
  scatterer.position = origin;
  scatterer.density = 0.0;
  ScatteringCount scattering_count;
  scattering_count.diffuse = 0;
  scattering_count.glossy = 0;
  scattering_count.specular = 0;

  // Boundaries of media end a segment, but add nothing to the depth.
  uint crossings = 0;
  TANDEM_RECORD(if (resumes_path()) {
    resumed_depth = state_word(2);
    crossings = state_word(3);
    origin = state_vector(4);
    scatterer.density = state_number(7);
    direction = state_vector(8);
    eta_scale = state_number(11);
    throughput = state_vector(12);
    medium = state_word(15);
    radiance = state_vector(16);
    ray_length = state_number(19);
    scatterer.position = state_vector(20);
    scattering_count.diffuse = state_word(23);
    scattering_count.glossy = state_word(24);
    scattering_count.specular = state_word(25);
  } else event_camera(pixel, sample_index, time, origin, direction);)
  TANDEM_RECORD(uint end_reason = END_DEPTH;)
  for (uint depth = PATH_FIRST_DEPTH; depth < max_depth; ++depth) {
    uint segment = depth + crossings;
    TANDEM_RECORD(end_reason = END_LIMIT;)
    TANDEM_RECORD(if (!event_segment(depth, crossings, origin, direction, ray_length, throughput, radiance, eta_scale,
                                     medium, scatterer.position, scatterer.density, scattering_count.diffuse,
                                     scattering_count.glossy, scattering_count.specular)) break;)
    TANDEM_RECORD(end_reason = END_DEPTH;)
    ray_count += 1;
    uint primitive = trace_closest(origin, direction, ray_length, key, segment_dimension(segment));
    precise Vertex vertex;
    vertex.in_medium = false;
    if (primitive != NO_PRIMITIVE) vertex.surface = surface_at(primitive, origin, direction, time);
    TANDEM_RECORD(if (primitive != NO_PRIMITIVE) event_surface(vertex.surface.material, vertex.surface.outside,
                                                               vertex.surface.position, vertex.surface.offset,
                                                               vertex.surface.geometric_normal,
                                                               vertex.surface.shading_normal,
                                                               vertex.surface.texture_coordinates.xy);)

    if (FEATURE_MEDIA && medium != NO_MEDIUM && !occlusion) {
      precise float surface_distance = RAY_LENGTH;
      if (primitive != NO_PRIMITIVE) surface_distance = det_length(vertex.surface.position - origin);
      uvec2 medium_bits = sampler_bits(key, medium_dimension(segment)).xy;
      precise MediumSample reached = sample_medium(medium, throughput, surface_distance, medium_bits);
      throughput = drop_negligible(throughput * reached.weight);
      TANDEM_RECORD(event_medium(medium_bits, reached.scattered, reached.distance, reached.weight);)
      TANDEM_RECORD(end_reason = END_ABSORBED;)
      if (max_component(throughput) == 0.0) break;
      TANDEM_RECORD(end_reason = END_DEPTH;)
      if (reached.scattered) {
        vertex.in_medium = true;
        primitive = NO_PRIMITIVE;
        vertex.surface.position = origin + direction * reached.distance;
        vertex.surface.geometric_normal = direction;
        vertex.surface.shading_normal = direction;
        vertex.surface.departure = vertex.surface.position;
        vertex.surface.side_normal = direction;
        vertex.surface.offset = 0.0;
        vertex.anisotropy = media[medium].anisotropy;
        vertex.has_density = true;
      }
    }

    if (!vertex.in_medium) {
      if (primitive == NO_PRIMITIVE) {
        TANDEM_RECORD(end_reason = END_ESCAPED;)
        TANDEM_RECORD(if (occlusion) event_end(end_reason, throughput, ray_count);)
        if (occlusion) return throughput;
        precise vec3 surroundings = weighted_environment(scatterer, direction);
        precise vec3 contribution = clamped(throughput * surroundings, depth + 1);
        radiance += contribution;
        TANDEM_RECORD(event_emission(true, surroundings, contribution);)
        break;
      }
      if (is_boundary(vertex.surface.material)) {
        medium = medium_beyond(vertex.surface.material, vertex.surface.outside);
        origin = offset_point(vertex.surface.position, vertex.surface.geometric_normal, vertex.surface.offset, direction);
        TANDEM_RECORD(end_reason = END_CROSSINGS;)
        if (crossings == MAX_CROSSINGS) break;
        crossings += 1;
        depth -= 1;  // 0 - 1 + 1 is 0
        continue;
      }
      TANDEM_RECORD(if (occlusion && depth == 1) event_end(END_OCCLUDED, vec3(0.0), ray_count);)
      if (occlusion && depth == 1) return vec3(0.0);
      if (!occlusion) {
        precise vec3 emission = weighted_emission(vertex.surface, primitive, scatterer, direction, time);
        precise vec3 contribution = clamped(throughput * emission, depth + 1);
        radiance += contribution;
        TANDEM_RECORD(event_emission(false, emission, contribution);)
      }
    }
    if (depth + 1 == max_depth || exceeds_depths(scattering_count)) break;

    vertex.primitive = primitive;
    vertex.frame = make_frame(vertex.surface.shading_normal);
    vertex.wo = to_local(vertex.frame, -direction);
    if (!vertex.in_medium) {
      vertex.parameters = bsdf_parameters(vertex.surface.material, vertex.surface.outside,
                                          vertex.surface.texture_coordinates, vertex.surface.position,
                                          vertex.surface.tint);
      // Occlusion is what a white diffuse surface under a white sky shows.
      if (occlusion) {
        vertex.parameters.model = MATERIAL_DIFFUSE;
        vertex.parameters.base_color = vec3(1.0);
        ray_length = render.occlusion_length;
      }
      vertex.has_density = bsdf_has_density(vertex.parameters);
    }
    bool estimates_lights = vertex.has_density && samples_lights() && !occlusion;
    if (estimates_lights) {
      precise vec3 light = direct_light(vertex, medium, time, key, segment, ray_count);
      precise vec3 contribution = clamped(throughput * light, depth + 2);
      radiance += contribution;
      TANDEM_RECORD(event_direct_light(contribution);)
    }

    uvec4 bits = sampler_bits(key, scattering_dimension(segment));
    vec3 u = vec3(unit_interval(bits.x), unit_interval(bits.y), unit_interval(bits.z));
    precise BsdfSample scattered;
    precise vec3 next_direction;
    bool leaves = false;
    for (uint attempt = 0; attempt < 2 && !leaves; ++attempt) {
      scattered = vertex_sample(vertex, u);
      next_direction = to_world(vertex.frame, scattered.direction);
      leaves = vertex.in_medium || on_its_side(vertex.surface, next_direction,
                                               (scattered.lobe & LOBE_TRANSMISSION) != 0 ? -1.0 : 1.0);
      // A specular lobe would lose all, so there the geometric normal decides; a density is folded or loses a part.
      if (vertex.has_density) break;
      vertex.frame = make_frame(vertex.surface.geometric_normal);
      vertex.wo = to_local(vertex.frame, -direction);
    }
    if (folds(vertex) && scattered.lobe != LOBE_NONE) {
      if (!leaves) next_direction = folded(vertex.surface, next_direction);
      if (has_folded(vertex, next_direction)) {
        precise BsdfValue found = value_towards(vertex, next_direction);
        leaves = found.density > 1e-20;
        scattered.density = found.density;
        if (leaves) scattered.weight = found.value * det_div(1.0, found.density);
      }
    }
    TANDEM_RECORD(event_scatter(bits, vertex.in_medium ? NO_MATERIAL_MODEL : vertex.parameters.model, scattered.lobe,
                                leaves, next_direction, scattered.weight, scattered.density, scattered.eta);)
    TANDEM_RECORD(end_reason = END_SIDE;)
    if (!leaves) break;

    throughput = drop_negligible(throughput * scattered.weight);
    TANDEM_RECORD(end_reason = END_ABSORBED;)
    if (max_component(throughput) == 0.0) break;
    eta_scale *= scattered.eta * scattered.eta;
    if (depth >= ROULETTE_DEPTH && option_roulette()) {
      precise float survival = max_component(throughput) * eta_scale;
      survival = survival < ROULETTE_SURVIVAL ? survival : ROULETTE_SURVIVAL;
      TANDEM_RECORD(event_roulette(bits.w, survival, unit_interval(bits.w) < survival);)
      TANDEM_RECORD(end_reason = END_ROULETTE;)
      if (unit_interval(bits.w) >= survival) break;
      throughput *= det_div(1.0, survival);
    }
    medium = medium_after(vertex, medium, (scattered.lobe & LOBE_TRANSMISSION) != 0);
    count_scattering(scattering_count, scattered.lobe);
    scatterer.position = vertex.surface.departure;
    scatterer.density = estimates_lights ? scattered.density : 0.0;
    origin = offset_point(vertex.surface.departure, vertex.surface.geometric_normal, vertex.surface.offset,
                          next_direction);
    direction = next_direction;
    TANDEM_RECORD(end_reason = END_DEPTH;)
  }
  TANDEM_RECORD(event_end(end_reason, radiance, ray_count);)
  return radiance;
}

#endif
