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
