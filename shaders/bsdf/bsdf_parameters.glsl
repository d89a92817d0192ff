// What a BSDF needs to know of the point that it scatters at.

#ifndef TANDEM_BSDF_BSDF_PARAMETERS
#define TANDEM_BSDF_BSDF_PARAMETERS

#include "bsdf/model.glsl"

struct BsdfParameters {
  uint model;  // MATERIAL_*
  vec3 base_color;
  vec3 reflectance;
  vec3 transmittance;
  float ior;
  bool outside;  // wo is on the side of the geometric normal, outside of a dielectric
  // With FEATURE_MATERIALS:
  vec3 eta;
  vec3 absorption;
  float roughness;
  float metallic;
  float exponent;
  float transmission;
  float specular;
  bool glossy_only;  // the value is that of the glossy lobes alone; the density remains that of all
};

#endif
