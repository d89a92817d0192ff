// What the path tracer reads and writes. The host side is pathtracer/scene_buffers.hpp, which must say the same; a test
// holds the two together through reflection.

#ifndef TANDEM_SCENE
#define TANDEM_SCENE

const uint MATERIAL_DIFFUSE = 0;
const uint MATERIAL_MIRROR = 1;
const uint MATERIAL_DIELECTRIC = 2;

struct Material {
  vec3 base_color;     // diffuse albedo (Kd)
  uint model;          // MATERIAL_*
  vec3 emission;       // radiance leaving both sides (Ke)
  float ior;           // index of refraction inside, relative to outside (Ni)
  vec3 reflectance;    // of a mirror (Ks)
  float opacity;       // the fraction of a triangle's points, or of the rays through one, that it covers (d)
  vec3 transmittance;  // factor on light refracted by a dielectric (Tf)
  uint alpha_texture;  // index of the texture that the opacity is multiplied by (map_d), or NO_TEXTURE
};

const uint NO_TEXTURE = 0xffffffffu;

// 8-bit texels, row by row from the top, four to a word from the least significant byte on.
struct AlphaTexture {
  uint first_texel;  // index of the upper left one
  uint width;
  uint height;
};

// One entry of the alias table over the emissive triangles (Vose 1991): take a uniform index i and 32 random bits; the
// light is entry i when the bits are below `threshold`, else entry `alias`.
struct Light {
  uint triangle;
  uint alias;
  uint threshold;
  float area_density;  // probability of this triangle / its area: the density of a uniform point on it, per unit area
};

const uint TRIANGLE_SMOOTH = 0x80000000u;  // bit of Triangle.material: the vertex normals are to be interpolated

struct Triangle {
  uvec3 vertices;
  uint material;  // index into materials, with TRIANGLE_SMOOTH
};

layout(set = 0, binding = 0) uniform accelerationStructureEXT scene_tlas;
layout(set = 0, binding = 1, std430) readonly buffer Positions { float positions[]; };  // x, y, z of each vertex, world space
layout(set = 0, binding = 2, std430) readonly buffer Normals { float normals[]; };      // x, y, z of each vertex, unit length
layout(set = 0, binding = 3, std430) readonly buffer Triangles { Triangle triangles[]; };
layout(set = 0, binding = 4, std430) readonly buffer Materials { Material materials[]; };
layout(set = 0, binding = 5, std430) readonly buffer Lights { Light lights[]; };  // light_count of them, never an empty buffer
// Of transparent triangles only.
layout(set = 0, binding = 6, std430) readonly buffer TextureCoordinates { float texture_coordinates[]; };  // u, v of each vertex
layout(set = 0, binding = 7, std430) readonly buffer AlphaTextures { AlphaTexture alpha_textures[]; };
layout(set = 0, binding = 8, std430) readonly buffer AlphaTexels { uint alpha_texels[]; };

// Pixel (x, y), y downwards, is element y * resolution.x + x.
layout(set = 1, binding = 0, std430) buffer RadianceSum { float radiance_sum[]; };  // r, g, b of each pixel, added in sample order
layout(set = 1, binding = 1, std430) buffer RayCounts { uint ray_counts[]; };       // rays traced for each pixel

layout(push_constant, std430) uniform RenderConstants {
  vec3 camera_position;
  uint first_sample;    // index of the first sample of this dispatch
  vec3 camera_right;    // length tan(horizontal field of view / 2)
  uint sample_count;    // samples of this dispatch
  vec3 camera_up;       // length tan(vertical field of view / 2)
  uint max_depth;       // path segments from the camera on: 1 sees emission only, 2 adds direct light
  vec3 camera_forward;  // unit length
  uint seed;
  vec3 background;      // radiance of rays that leave the scene
  uint light_count;
  uvec2 resolution;
  uvec2 tile_offset;    // first pixel of this dispatch
  uvec2 tile_size;      // its pixels; invocations beyond do nothing
  uint opaque_count;    // triangles from this index on may be transparent; they are the second geometry
} render;

#endif
