// What the path tracer reads and writes. The host side is pathtracer/scene/buffers.hpp, which must say the same; a test
// holds the two together through reflection.

#ifndef TANDEM_SCENE
#define TANDEM_SCENE

#include "bsdf/model.glsl"
#include "features.glsl"

const uint NO_TEXTURE = 0xffffffffu;
const uint NO_MEDIUM = 0xffffffffu;

// Each *_texture is an index into textures, or NO_TEXTURE, and multiplies what it is named after.
struct Material {
  vec3 base_color;       // diffuse albedo (Kd)
  uint model;            // MATERIAL_*
  vec3 emission;         // radiance leaving both sides (Ke)
  float ior;             // index of refraction inside, relative to outside (Ni)
  vec3 reflectance;      // of a mirror or a glossy lobe (Ks); principled: colour of its dielectric reflection
  float opacity;         // the fraction of a triangle's points, or of the rays through one, that it covers (d)
  vec3 transmittance;    // factor on light refracted (Tf)
  uint alpha_texture;    // of the opacity (map_d)
  vec3 eta;              // of a conductor: real part of the index of refraction
  float roughness;       // perceptual, in [0, 1]: the GGX alpha is its square
  vec3 absorption;       // of a conductor: imaginary part
  float metallic;        // principled, in [0, 1]
  float exponent;        // of Phong and Blinn-Phong (Ns)
  float transmission;    // principled, in [0, 1]
  float specular;        // principled: strength of the dielectric reflection, in [0, 1]
  float normal_scale;    // of the normal map's x and y; of a bump map: height in scene units
  uint base_color_texture;
  uint emission_texture;
  uint reflectance_texture;
  uint roughness_texture;
  uint metallic_texture;
  uint transmission_texture;
  uint transmittance_texture;
  uint specular_texture;
  uint exponent_texture;
  uint normal_texture;   // tangent space, [0, 1] for [-1, 1]
  uint bump_texture;     // heights
  uint medium;           // inside, index into media, or NO_MEDIUM
  float alpha_cutoff;    // 0: opacity is a fraction; else covered where the opacity is at least this, and nowhere else
  uint attributes;       // ATTRIBUTE_*: what of vertex_attributes counts
  uint reserved_1;
  uint reserved_2;
};

// Bits of Material.attributes, with FEATURE_TEXTURES.
const uint ATTRIBUTE_COLOR = 1;
const uint ATTRIBUTE_OPACITY = 2;
const uint ATTRIBUTE_TANGENT = 4;
const uint ATTRIBUTE_TEXTURE_COORDINATES = 8;
const uint ATTRIBUTE_EMISSION = 16;  // with ATTRIBUTE_COLOR: the colour is a factor on the emission too

const uint TEXTURE_IMAGE = 0;
const uint TEXTURE_CHECKER = 1;  // color_a and color_b in squares of side 1 / scale of (u, v)
const uint TEXTURE_NOISE = 2;    // from color_a to color_b by turbulence in object space of frequency `scale`
const uint TEXTURE_UNIFORM = 3;  // color_a

// Of an image: how its texels lie in the words of texels, rows from the top, channels r g b a.
const uint TEXEL_UNORM8 = 0;       // one word, r in the least significant byte
const uint TEXEL_SRGB8 = 1;        // likewise, r g b sRGB-encoded: their values are in the table at texels[0..255]
const uint TEXEL_UNORM16 = 2;      // two words, r in the less significant half of the first
const uint TEXEL_HALF = 3;         // likewise
const uint TEXEL_FLOAT = 4;        // four words
const uint TEXEL_SINGLE_UNORM8 = 5;  // one channel, four texels to a word from the least significant byte on; r = g = b = a

const uint ADDRESS_REPEAT = 0;
const uint ADDRESS_CLAMP = 1;
const uint ADDRESS_MIRROR = 2;

const uint FILTER_NEAREST = 0;
const uint FILTER_LINEAR = 1;

// A use of an image, or a procedural pigment.
struct Texture {
  uint kind;        // TEXTURE_*
  uint format;      // TEXEL_*
  uint first_word;  // of the upper left texel in texels; TEXEL_SINGLE_UNORM8: index of the texel, in bytes
  uint address;     // ADDRESS_* of u, and that of v shifted left by 8
  uint width;
  uint height;
  uint filter_mode;  // FILTER_*
  uint channel;     // that a single number is read from: 0 to 3, or 4 for the luminance of r g b
  vec3 u_row;       // u of the texture is u_row.x * u + u_row.y * v + u_row.z of the vertices' coordinates, v upwards
  float scale;
  vec3 v_row;
  uint coordinates;  // which of the vertices' texture coordinates: 0, or 1 for those of vertex_attributes
  vec3 color_a;     // image: factor
  float alpha_a;
  vec3 color_b;
  float alpha_b;
};

const uint LIGHT_TRIANGLE = 0;     // primitive
const uint LIGHT_SPHERE = 1;       // primitive
// Without extent:
const uint LIGHT_POINT = 2;        // position, radiance: its intensity (per steradian)
const uint LIGHT_SPOT = 3;         // likewise; direction, cosine_inner, cosine_outer
const uint LIGHT_DIRECTIONAL = 4;  // direction, radiance: its irradiance across the direction
const uint LIGHT_ENVIRONMENT = 5;  // everything around (light/environment.glsl)

// A light, and its entry in the alias table over all of them (Vose 1991): take a uniform index i and 32 random bits; the
// light is entry i when the bits are below `threshold`, else entry `alias`.
struct Light {
  uint primitive;      // LIGHT_TRIANGLE: the triangle; LIGHT_SPHERE: the number of triangles + the sphere
  uint alias;
  uint threshold;
  float area_density;  // LIGHT_TRIANGLE: probability / its area, the density of a uniform point on it
  uint kind;           // LIGHT_*
  float probability;   // with which the table gives this light
  float cosine_inner;  // LIGHT_SPOT: full intensity within
  float cosine_outer;  // nothing beyond
  vec3 position;
  float reserved_0;
  vec3 direction;      // unit, in which the light shines
  float reserved_1;
  vec3 radiance;
  float reserved_2;
};

const uint NO_LIGHT = 0xffffffffu;

const uint TRIANGLE_SMOOTH = 0x80000000u;  // bit of Triangle.material: the vertex normals are to be interpolated

struct Triangle {
  uvec3 vertices;
  uint material;  // index into materials, with TRIANGLE_SMOOTH
};

// Of each vertex, beside its position, normal and texture coordinates.
struct VertexAttributes {
  vec4 tangent;              // unit, the direction in which s of the normal map grows; w: 1, or -1 where t is mirrored
  vec3 color;                // factor on the base colour
  float opacity;             // factor on the opacity
  vec2 texture_coordinates;  // a second set
  vec2 reserved;
};

struct Sphere {
  vec3 centre;   // when the shutter opens
  float radius;
  vec3 motion;   // of the centre until it closes
  uint material;
};

// Of an environment map: the alias table over its texels, rows from the top.
struct EnvironmentCell {
  uint threshold;
  uint alias;
  float density;  // of a direction within the texel, per solid angle
};

// Constant density; per unit length.
struct Medium {
  vec3 absorption;
  float anisotropy;  // g of Henyey and Greenstein's phase function, in (-1, 1)
  vec3 scattering;
  uint reserved;
};

const uint CAMERA_PERSPECTIVE = 0;
const uint CAMERA_ORTHOGRAPHIC = 1;      // right and up are half the width and the height of what it sees
const uint CAMERA_EQUIRECTANGULAR = 2;   // right, up, forward have length 1; forward is in the centre of the picture

const uint SAMPLER_INDEPENDENT = 0;
const uint SAMPLER_STRATIFIED = 1;
const uint SAMPLER_HALTON = 2;
const uint SAMPLER_HAMMERSLEY = 3;
const uint SAMPLER_SOBOL = 4;       // Owen-scrambled
const uint SAMPLER_BLUE_NOISE = 5;  // Sobol, its error dithered over neighbouring pixels

const uint INTEGRATOR_PATH = 0;
const uint INTEGRATOR_DIRECT = 1;             // point-light tracing: emission and direct light, behind specular lobes only
const uint INTEGRATOR_AMBIENT_OCCLUSION = 2;  // the unoccluded fraction of cosine-weighted directions

const uint MIS_NONE = 0;      // a light counts by next event estimation only, where that can find it
const uint MIS_BALANCE = 1;
const uint MIS_POWER = 2;

const uint BSDF_SAMPLING_BSDF = 0;     // as each model samples best
const uint BSDF_SAMPLING_COSINE = 1;   // lobes with a density: cosine-weighted over the hemisphere
const uint BSDF_SAMPLING_UNIFORM = 2;  // likewise uniformly

layout(set = 0, binding = 0) uniform accelerationStructureEXT scene_tlas;
layout(set = 0, binding = 1, std430) readonly buffer Positions { float positions[]; };  // x, y, z of each vertex, world space
layout(set = 0, binding = 2, std430) readonly buffer Normals { float normals[]; };      // x, y, z of each vertex, unit length
layout(set = 0, binding = 3, std430) readonly buffer Triangles { Triangle triangles[]; };
layout(set = 0, binding = 4, std430) readonly buffer Materials { Material materials[]; };
// None of these is ever empty, whatever it stands for.
layout(set = 0, binding = 5, std430) readonly buffer Lights { Light lights[]; };                      // render.light_count of them
layout(set = 0, binding = 6, std430) readonly buffer TextureCoordinates { float texture_coordinates[]; };  // u, v of each vertex
layout(set = 0, binding = 7, std430) readonly buffer Textures { Texture textures[]; };
layout(set = 0, binding = 8, std430) readonly buffer Texels { uint texels[]; };                       // the first 256: sRGB to linear, as floats
layout(set = 0, binding = 9, std430) readonly buffer PrimitiveLights { uint primitive_lights[]; };    // index into lights of each triangle, then of each sphere, or NO_LIGHT
layout(set = 0, binding = 10, std430) readonly buffer Spheres { Sphere spheres[]; };
layout(set = 0, binding = 11, std430) readonly buffer EnvironmentCells { EnvironmentCell environment_cells[]; };
layout(set = 0, binding = 12, std430) readonly buffer Media { Medium media[]; };

layout(set = 0, binding = 14, std430) readonly buffer Attributes { VertexAttributes vertex_attributes[]; };

struct RenderConstants {
  vec3 camera_position;
  uint camera_kind;        // CAMERA_*
  vec3 camera_right;       // length tan(horizontal field of view / 2)
  float lens_radius;       // 0: a pinhole
  vec3 camera_up;          // length tan(vertical field of view / 2)
  float focus_distance;    // along camera_forward, to what is sharp
  vec3 camera_forward;     // unit length
  uint triangle_count;     // primitives from this index on are spheres
  vec3 camera_motion;      // of camera_position while the shutter is open
  uint opaque_count;       // triangles from this index on may be transparent; they are the second geometry
  vec3 background;         // radiance of rays that leave the scene; factor on the environment map
  uint light_count;
  uvec2 resolution;
  uint max_depth;          // path segments from the camera on: 1 sees emission only, 2 adds direct light
  uint seed;
  uint sampler_kind;       // SAMPLER_*
  uint sampler_total;      // samples of a pixel that are planned: what Hammersley and stratification divide by
  uint integrator;         // INTEGRATOR_*
  uint light_sampling;     // 1: next event estimation, 0: none
  uint mis;                // MIS_*
  uint bsdf_sampling;      // BSDF_SAMPLING_*
  uint roulette;           // 1: Russian roulette, 0: none
  uint max_diffuse_depth;  // scattering events of a path by lobes of each kind, before the one that meets a light
  uint max_glossy_depth;
  uint max_specular_depth;
  float clamp_direct;      // largest channel of what light adds that came along at most two segments; 0: no bound
  float clamp_indirect;    // along more of them
  float occlusion_length;  // of rays of INTEGRATOR_AMBIENT_OCCLUSION
  uint environment_texture;  // equirectangular, into textures, or NO_TEXTURE: the background alone
  uint environment_light;    // into lights, or NO_LIGHT
  uint medium;               // around the camera and everything, into media, or NO_MEDIUM
  vec3 environment_right;    // the directions that the map's centre has to its right, above and before it; orthonormal
  float shutter;             // 1: spheres or the camera move, 0: all stands still
  vec3 environment_up;
  uint terminator_offset;    // 1: rays leave smooth triangles from the round surface that their normals mean
  vec3 environment_forward;
  float reserved_1;
};

layout(set = 0, binding = 13, std430) readonly buffer Render { RenderConstants render; };

// Pixel (x, y), y downwards, is element y * resolution.x + x.
layout(set = 1, binding = 0, std430) buffer RadianceSum { float radiance_sum[]; };  // r, g, b of each pixel, added in sample order
layout(set = 1, binding = 1, std430) buffer RayCounts { uint ray_counts[]; };       // rays traced for each pixel

layout(push_constant, std430) uniform DispatchConstants {
  uvec2 tile_offset;   // first pixel of this dispatch
  uvec2 tile_size;     // its pixels; invocations beyond do nothing
  uint first_sample;   // index of the first sample of this dispatch
  uint sample_count;   // samples of this dispatch
} dispatch;

#endif
