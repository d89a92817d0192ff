// The BSDF parameters of a point: the members of its Material with their textures applied.

#ifndef TANDEM_BSDF_PARAMETERS
#define TANDEM_BSDF_PARAMETERS

#include "bsdf/bsdf_parameters.glsl"
#include "scene.glsl"
#include "texture/texture.glsl"

/// The texture of a member of a material, counted from 0: base_color, reflectance, transmittance, roughness, metallic,
/// exponent, transmission, specular.
uint parameter_texture(uint material, uint member) {
  switch (member) {
    case 0:
      return materials[material].base_color_texture;
    case 1:
      return materials[material].reflectance_texture;
    case 2:
      return materials[material].transmittance_texture;
    case 3:
      return materials[material].roughness_texture;
    case 4:
      return materials[material].metallic_texture;
    case 5:
      return materials[material].exponent_texture;
    case 6:
      return materials[material].transmission_texture;
    default:
      return materials[material].specular_texture;
  }
}

/// @param uv, position where the surface is: what textures are read at @param tint of the vertices
precise BsdfParameters bsdf_parameters(uint material, bool outside, vec4 uv, vec3 position, vec3 tint) {
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
    parameters.glossy_only = false;
  }
  if (FEATURE_TEXTURES) {
    parameters.base_color *= tint;
    // A loop, so that the code that reads a texture is there once.
    const uint count = FEATURE_MATERIALS ? 8 : 3;
    for (uint member = 0; member < count; ++member) {
      uint texture_index = parameter_texture(material, member);
      if (texture_index == NO_TEXTURE) continue;
      vec4 value = texture_at(texture_index, uv, position);
      float number = texture_channel(texture_index, value);
      switch (member) {
        case 0:
          parameters.base_color *= value.xyz;
          break;
        case 1:
          parameters.reflectance *= value.xyz;
          break;
        case 2:
          parameters.transmittance *= value.xyz;
          break;
        case 3:
          parameters.roughness *= number;
          break;
        case 4:
          parameters.metallic *= number;
          break;
        case 5:
          parameters.exponent *= number;
          break;
        case 6:
          parameters.transmission *= number;
          break;
        default:
          parameters.specular *= number;
      }
    }
  }
  return parameters;
}

#endif
