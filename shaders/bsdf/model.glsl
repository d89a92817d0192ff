// The models of Material.model, and the members of Material that each one uses.

#ifndef TANDEM_BSDF_MODEL
#define TANDEM_BSDF_MODEL

const uint MATERIAL_DIFFUSE = 0;     // Lambert: base_color
const uint MATERIAL_MIRROR = 1;      // reflectance
const uint MATERIAL_DIELECTRIC = 2;  // smooth: ior, transmittance
// With FEATURE_MATERIALS:
const uint MATERIAL_OREN_NAYAR = 3;   // base_color, roughness (standard deviation of the facets' slope angle, radians)
const uint MATERIAL_PHONG = 4;        // base_color, and a lobe of reflectance and exponent around the mirror direction
const uint MATERIAL_BLINN_PHONG = 5;  // likewise around the half vector
const uint MATERIAL_CONDUCTOR = 6;    // GGX: roughness; eta and absorption, or where eta is 0 reflectance by Schlick
const uint MATERIAL_ROUGH_DIELECTRIC = 7;  // GGX: roughness, ior, transmittance
const uint MATERIAL_THIN = 8;              // a sheet without thickness: ior, transmittance
// glTF 2.0: base_color, metallic, roughness, ior, specular, reflectance (the colour of its dielectric reflection), and
// transmission, by which it is a sheet without thickness, as without KHR_materials_volume.
const uint MATERIAL_PRINCIPLED = 9;
const uint MATERIAL_BOUNDARY = 10;  // no surface at all: where a medium begins (FEATURE_MEDIA)

#endif
