// What a BSDF needs to know of the point that it scatters at: the members of Material with their textures applied.

#ifndef TANDEM_BSDF_PARAMETERS
#define TANDEM_BSDF_PARAMETERS

#include "scene.glsl"
#include "texture/texture.glsl"

struct BsdfParameters {
  uint model;          // MATERIAL_*
  vec3 base_color;
  vec3 reflectance;
  vec3 transmittance;
  float ior;
  bool outside;        // wo is on the side of the geometric normal, outside of a dielectric
  // With FEATURE_MATERIALS:
  vec3 eta;
  vec3 absorption;
  float roughness;
  float metallic;
  float exponent;
  float transmission;
  float specular;
};

/// @param uv, position where the surface is: what textures are read at
precise BsdfParameters bsdf_parameters(uint material, bool outside, vec2 uv, vec3 position) {
  BsdfParameters parameters;
  parameters.model = materials[material].model;
  parameters.base_color = materials[material].base_color;
  parameters.reflectance = materials[material].reflectance;
  parameters.transmittance = materials[material].transmittance;
  parameters.ior = materials[material].ior;
  parameters.outside = outside;
  if (FEATURE_MATERIALS) {
    parameters.eta = materials[material].eta;
    parameters.absorption = materials[material].absorption;
    parameters.roughness = materials[material].roughness;
    parameters.metallic = materials[material].metallic;
    parameters.exponent = materials[material].exponent;
    parameters.transmission = materials[material].transmission;
    parameters.specular = materials[material].specular;
  }
  if (FEATURE_TEXTURES) {
    parameters.base_color *= texture_color(materials[material].base_color_texture, uv, position);
    parameters.reflectance *= texture_color(materials[material].reflectance_texture, uv, position);
    parameters.transmittance *= texture_color(materials[material].transmittance_texture, uv, position);
    if (FEATURE_MATERIALS) {
      parameters.roughness *= texture_value(materials[material].roughness_texture, uv, position);
      parameters.metallic *= texture_value(materials[material].metallic_texture, uv, position);
      parameters.exponent *= texture_value(materials[material].exponent_texture, uv, position);
      parameters.transmission *= texture_value(materials[material].transmission_texture, uv, position);
      parameters.specular *= texture_value(materials[material].specular_texture, uv, position);
    }
  }
  return parameters;
}

#endif
