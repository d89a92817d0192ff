// A perfect mirror. Directions are unit vectors in the shading frame and point away from the surface.

#ifndef TANDEM_BSDF_MIRROR
#define TANDEM_BSDF_MIRROR

#include "bsdf/bsdf_sample.glsl"

BsdfSample mirror_sample(vec3 reflectance, vec3 wo) {
  return BsdfSample(vec3(-wo.x, -wo.y, wo.z), reflectance, 0.0, LOBE_SPECULAR, 1.0);
}

#endif
