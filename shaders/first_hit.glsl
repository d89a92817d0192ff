// What an invocation does that looks at what a pixel shows first: it adds a range of samples to sums of albedo, normal
// and depth. The rays are those of the path tracer's samples.

#ifndef TANDEM_FIRST_HIT
#define TANDEM_FIRST_HIT

#include "bsdf/albedo.glsl"
#include "bsdf/parameters.glsl"
#include "camera/camera.glsl"
#include "geometry/surface.glsl"
#include "light/emission.glsl"
#include "light/environment.glsl"
#include "scene.glsl"
#include "trace.glsl"

// pathtracer/render/renderer_first_hits.cpp says the same.
struct FirstHit {
  vec3 albedo;     // sum over the samples that hit anything
  float depth;     // likewise, distance from where the ray begins
  vec3 normal;     // likewise, of shading, towards the camera
  float count;     // samples that hit anything
  uint primitive;  // of sample 0, or NO_PRIMITIVE
  uint material;   // likewise
  uint reserved_0;
  uint reserved_1;
  vec3 emission;  // sum over all samples: of what is hit, or of what is behind everything
  uint reserved_2;
};

layout(set = 1, binding = 2, std430) buffer FirstHits { FirstHit first_hits[]; };

/// Adds one sample. Begins the sums with sample 0.
void add_first_hit(uvec2 pixel, uint sample_index) {
  uint index = pixel.y * render.resolution.x + pixel.x;
  RandomKey key;
  key.pixel = pixel.x + (pixel.y << 16);
  key.sample_index = sample_index;
  key.seed = render.seed;
  precise float time = shutter_time(key);
  precise CameraRay ray = camera_ray(pixel, key, time);
  uint primitive = trace_closest(ray.origin, ray.direction, RAY_LENGTH, key, segment_dimension(0));
  if (sample_index == 0) {
    first_hits[index].albedo = vec3(0.0);
    first_hits[index].depth = 0.0;
    first_hits[index].normal = vec3(0.0);
    first_hits[index].count = 0.0;
    first_hits[index].emission = vec3(0.0);
    first_hits[index].primitive = primitive;
    first_hits[index].material = NO_PRIMITIVE;
  }
  if (primitive == NO_PRIMITIVE) {
    precise vec3 beyond = first_hits[index].emission + environment_radiance(ray.direction);
    first_hits[index].emission = beyond;
    return;
  }
  precise Surface surface = surface_at(primitive, ray.origin, ray.direction, time);
  BsdfParameters parameters =
      bsdf_parameters(surface.material, surface.outside, surface.texture_coordinates, surface.position, surface.tint);
  if (sample_index == 0) first_hits[index].material = surface.material;
  precise vec3 albedo = first_hits[index].albedo + bsdf_albedo(parameters);
  precise float depth = first_hits[index].depth + det_length(surface.position - ray.origin);
  precise vec3 normal = first_hits[index].normal + surface.shading_normal;
  precise float count = first_hits[index].count + 1.0;
  precise vec3 emission =
      first_hits[index].emission +
      emitted_radiance(surface.material, surface.texture_coordinates, surface.position, surface.tint);
  first_hits[index].emission = emission;
  first_hits[index].albedo = albedo;
  first_hits[index].depth = depth;
  first_hits[index].normal = normal;
  first_hits[index].count = count;
}

void first_hit(uvec2 position) {
  if (any(greaterThanEqual(position, dispatch.tile_size))) return;
  uvec2 pixel = dispatch.tile_offset + position;
  if (any(greaterThanEqual(pixel, render.resolution))) return;
  for (uint i = 0; i < dispatch.sample_count; ++i) add_first_hit(pixel, dispatch.first_sample + i);
}

#endif
