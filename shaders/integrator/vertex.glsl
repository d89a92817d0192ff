// Where a path scatters: on a surface by its BSDF, within a medium by its phase function. wi and wo are unit vectors in
// the frame of the vertex and point away from it; wo is where the path came from.

#ifndef TANDEM_INTEGRATOR_VERTEX
#define TANDEM_INTEGRATOR_VERTEX

#include "bsdf/bsdf.glsl"
#include "geometry/frame.glsl"
#include "geometry/surface.glsl"
#include "integrator/hemisphere.glsl"
#include "integrator/medium.glsl"
#include "integrator/phase_function.glsl"

struct Vertex {
  Surface surface;   // in a medium: the position, no offset, and the direction of travel as both normals
  uint primitive;    // or NO_PRIMITIVE
  Frame frame;       // z is the shading normal
  vec3 wo;
  bool in_medium;
  float anisotropy;           // in a medium
  BsdfParameters parameters;  // on a surface
  bool has_density;           // light sampling can find directions that it scatters to
};

/// The BSDF times the cosine, or the phase function; and the solid-angle density of vertex_sample at wi.
precise BsdfValue vertex_value(Vertex vertex, vec3 wi) {
  if (FEATURE_MEDIA && vertex.in_medium) {
    float phase = phase_density(vertex.anisotropy, wi.z);
    return BsdfValue(vec3(phase), phase);
  }
  precise BsdfValue found = bsdf_value(vertex.parameters, vertex.wo, wi);
  found.value *= abs(wi.z);
  if (samples_hemisphere(vertex.has_density)) found.density = hemisphere_density(vertex.parameters, wi);
  return found;
}

/// Whether a scattered direction is on the side of the surface (side_normal) that wi.z says of the shading frame. Interpolated
/// and mapped normals can send it to the other.
bool on_its_side(Surface surface, vec3 direction, float wi_z) {
  precise float agreement = det_dot(direction, surface.side_normal) * wi_z;
  return agreement > 0.0;
}

/// Whether what glossy lobes scatter to the wrong side of the true surface is turned back to the right one: mirrored at
/// the surface, so that none of it is lost. A diffuse lobe loses it, as it would shine where the light is grazing.
bool folds(Vertex vertex) {
  if (!FEATURE_MATERIALS || vertex.in_medium || !vertex.has_density) return false;
  if (vertex.parameters.model == MATERIAL_DIFFUSE || vertex.parameters.model == MATERIAL_OREN_NAYAR) return false;
  return vertex.surface.shading_normal != vertex.surface.side_normal;
}

/// A direction mirrored at the true surface.
precise vec3 folded(Surface surface, vec3 direction) {
  return direction - surface.side_normal * (2.0 * det_dot(direction, surface.side_normal));
}

/// Whether the glossy lobes send light to `direction` by way of its mirror image.
bool has_folded(Vertex vertex, vec3 direction) {
  if (!folds(vertex)) return false;
  vec3 image = folded(vertex.surface, direction);
  // The image is on the other side of the surface: it belongs there, or it is turned to this side.
  return on_its_side(vertex.surface, direction, to_local(vertex.frame, image).z);
}

/// vertex_value for a direction in world space, with what is turned back to it from the wrong side of the true surface.
precise BsdfValue value_towards(Vertex vertex, vec3 direction) {
  precise BsdfValue sum;
  sum.value = vec3(0.0);
  sum.density = 0.0;
  // A loop, so that the code of the BSDF is there once.
  const uint images = has_folded(vertex, direction) ? 2 : 1;
  for (uint image = 0; image < images; ++image) {
    vec3 towards = direction;
    if (image == 1) towards = folded(vertex.surface, direction);
    precise vec3 wi = to_local(vertex.frame, towards);
    if (!on_its_side(vertex.surface, direction, wi.z)) continue;
    if (FEATURE_MATERIALS) vertex.parameters.glossy_only = image == 1;
    precise BsdfValue found = vertex_value(vertex, wi);
    sum.value += found.value;
    sum.density += found.density;
  }
  return sum;
}

/// The medium into which the vertex scatters, from the one around it.
uint medium_after(Vertex vertex, uint medium, bool transmitted) {
  if (!FEATURE_MEDIA || !transmitted || vertex.in_medium) return medium;
  // What has no thickness has no inside.
  if (vertex.parameters.model == MATERIAL_THIN || vertex.parameters.model == MATERIAL_PRINCIPLED) return medium;
  return medium_beyond(vertex.surface.material, vertex.surface.outside);
}

/// A scattered direction. u in [0, 1)^3.
precise BsdfSample vertex_sample(Vertex vertex, vec3 u) {
  if (FEATURE_MEDIA && vertex.in_medium) {
    vec3 wi = sample_phase(vertex.anisotropy, u.xy);
    return BsdfSample(wi, vec3(1.0), phase_density(vertex.anisotropy, wi.z), LOBE_DIFFUSE, 1.0);
  }
  if (samples_hemisphere(vertex.has_density)) return hemisphere_sample(vertex.parameters, vertex.wo, u);
  return bsdf_sample(vertex.parameters, vertex.wo, u);
}

#endif
