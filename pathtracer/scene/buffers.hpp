#pragma once

#include <cstddef>
#include <cstdint>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

/// The structures of shaders/scene.glsl, byte for byte (std430). What each member means is said there; what a shader
/// never reads is left out here.
namespace tandem::pathtracer {

enum class MaterialModel : std::uint32_t {
  diffuse = 0,
  mirror = 1,
  dielectric = 2,
  oren_nayar = 3,
  phong = 4,
  blinn_phong = 5,
  conductor = 6,
  rough_dielectric = 7,
  thin = 8,
  principled = 9,
  boundary = 10
};

/// Where set 0 of the shaders binds each buffer.
namespace binding {
inline constexpr std::uint32_t scene_tlas = 0;
inline constexpr std::uint32_t positions = 1;
inline constexpr std::uint32_t normals = 2;
inline constexpr std::uint32_t triangles = 3;
inline constexpr std::uint32_t materials = 4;
inline constexpr std::uint32_t lights = 5;
inline constexpr std::uint32_t texture_coordinates = 6;
inline constexpr std::uint32_t textures = 7;
inline constexpr std::uint32_t texels = 8;
inline constexpr std::uint32_t primitive_lights = 9;
inline constexpr std::uint32_t spheres = 10;
inline constexpr std::uint32_t environment_cells = 11;
inline constexpr std::uint32_t media = 12;
inline constexpr std::uint32_t render = 13;  ///< RenderConstants
inline constexpr std::uint32_t attributes = 14;
}  // namespace binding

inline constexpr std::uint32_t no_texture = 0xffffffffu;
inline constexpr std::uint32_t no_medium = 0xffffffffu;
inline constexpr std::uint32_t no_light = 0xffffffffu;

/// What of GpuVertexAttributes counts for a material.
namespace vertex_attribute {
inline constexpr std::uint32_t color = 1;
inline constexpr std::uint32_t opacity = 2;
inline constexpr std::uint32_t tangent = 4;
inline constexpr std::uint32_t texture_coordinates = 8;
inline constexpr std::uint32_t emission = 16;  ///< with color
}  // namespace vertex_attribute

struct GpuMaterial {
  glm::vec3 base_color{0.5f};
  MaterialModel model = MaterialModel::diffuse;
  glm::vec3 emission{0};
  float ior = 1;
  glm::vec3 reflectance{0};
  float opacity = 1;
  glm::vec3 transmittance{1};
  std::uint32_t alpha_texture = no_texture;
  glm::vec3 eta{0};
  float roughness = 0;
  glm::vec3 absorption{0};
  float metallic = 0;
  float exponent = 0;
  float transmission = 0;
  float specular = 1;
  float normal_scale = 1;
  std::uint32_t base_color_texture = no_texture;
  std::uint32_t emission_texture = no_texture;
  std::uint32_t reflectance_texture = no_texture;
  std::uint32_t roughness_texture = no_texture;
  std::uint32_t metallic_texture = no_texture;
  std::uint32_t transmission_texture = no_texture;
  std::uint32_t transmittance_texture = no_texture;
  std::uint32_t specular_texture = no_texture;
  std::uint32_t exponent_texture = no_texture;
  std::uint32_t normal_texture = no_texture;
  std::uint32_t bump_texture = no_texture;
  std::uint32_t medium = no_medium;
  float alpha_cutoff = 0;
  std::uint32_t attributes = 0;  ///< of vertex_attribute
  std::uint32_t reserved[2] = {};
};
static_assert(sizeof(GpuMaterial) == 176);

enum class TextureKind : std::uint32_t { image = 0, checker = 1, noise = 2, uniform = 3 };
enum class TexelFormat : std::uint32_t { unorm8 = 0, srgb8 = 1, unorm16 = 2, half = 3, float32 = 4, single_unorm8 = 5 };
enum class TextureAddress : std::uint32_t { repeat = 0, clamp = 1, mirror = 2 };
enum class TextureFilter : std::uint32_t { nearest = 0, linear = 1 };

/// `GpuTexture::channel` of a number that is the luminance of red, green and blue.
inline constexpr std::uint32_t luminance_channel = 4;

struct GpuTexture {
  TextureKind kind = TextureKind::image;
  TexelFormat format = TexelFormat::unorm8;
  std::uint32_t first_word = 0;
  std::uint32_t address = 0;  ///< TextureAddress of u, and that of v shifted left by 8
  std::uint32_t width = 1;
  std::uint32_t height = 1;
  TextureFilter filter = TextureFilter::linear;
  std::uint32_t channel = 0;
  glm::vec3 u_row{1, 0, 0};
  float scale = 1;
  glm::vec3 v_row{0, 1, 0};
  std::uint32_t coordinates = 0;  ///< which set of texture coordinates: 0, or 1 for that of GpuVertexAttributes
  glm::vec3 color_a{1};
  float alpha_a = 1;
  glm::vec3 color_b{0};
  float alpha_b = 1;
};
static_assert(sizeof(GpuTexture) == 96);

enum class LightKind : std::uint32_t {
  triangle = 0,
  sphere = 1,
  point = 2,
  spot = 3,
  directional = 4,
  environment = 5
};

struct GpuLight {
  std::uint32_t primitive = 0;
  std::uint32_t alias = 0;
  std::uint32_t threshold = 0;
  float area_density = 0;
  LightKind kind = LightKind::triangle;
  float probability = 0;
  float cosine_inner = 1;
  float cosine_outer = 0;
  glm::vec3 position{0};
  float reserved_0 = 0;
  glm::vec3 direction{0, 0, -1};
  float reserved_1 = 0;
  glm::vec3 radiance{0};
  float reserved_2 = 0;
};
static_assert(sizeof(GpuLight) == 80);

inline constexpr std::uint32_t triangle_smooth = 0x80000000u;

struct GpuTriangle {
  std::uint32_t vertices[3];
  std::uint32_t material;
};
static_assert(sizeof(GpuTriangle) == 16);

struct GpuVertexAttributes {
  glm::vec4 tangent{1, 0, 0, 1};
  glm::vec3 color{1};
  float opacity = 1;
  glm::vec2 texture_coordinates{0};
  glm::vec2 reserved{0};
};
static_assert(sizeof(GpuVertexAttributes) == 48);

struct GpuSphere {
  glm::vec3 centre{0};
  float radius = 1;
  glm::vec3 motion{0};
  std::uint32_t material = 0;
};
static_assert(sizeof(GpuSphere) == 32);

struct GpuEnvironmentCell {
  std::uint32_t threshold;
  std::uint32_t alias;
  float density;
};
static_assert(sizeof(GpuEnvironmentCell) == 12);

struct GpuMedium {
  glm::vec3 absorption{0};
  float anisotropy = 0;
  glm::vec3 scattering{0};
  std::uint32_t reserved = 0;
};
static_assert(sizeof(GpuMedium) == 32);

enum class CameraKind : std::uint32_t { perspective = 0, orthographic = 1, equirectangular = 2 };
enum class SamplerKind : std::uint32_t {
  independent = 0,
  stratified = 1,
  halton = 2,
  hammersley = 3,
  sobol = 4,
  blue_noise = 5
};
/// metropolis: the chains of shaders/metropolis over paths of integrator path; no shader knows the value.
enum class Integrator : std::uint32_t { path = 0, direct = 1, ambient_occlusion = 2, metropolis = 3 };
enum class Mis : std::uint32_t { none = 0, balance = 1, power = 2 };
enum class BsdfSampling : std::uint32_t { bsdf = 0, cosine = 1, uniform = 2 };

/// What stays the same from dispatch to dispatch: the camera, the settings, sizes of the scene.
struct RenderConstants {
  glm::vec3 camera_position{0};
  CameraKind camera_kind = CameraKind::perspective;
  glm::vec3 camera_right{1, 0, 0};
  float lens_radius = 0;
  glm::vec3 camera_up{0, 1, 0};
  float focus_distance = 1;
  glm::vec3 camera_forward{0, 0, -1};
  std::uint32_t triangle_count = 0;
  glm::vec3 camera_motion{0};
  std::uint32_t opaque_count = 0;
  glm::vec3 background{0};
  std::uint32_t light_count = 0;
  glm::uvec2 resolution{1};
  std::uint32_t max_depth = 8;
  std::uint32_t seed = 0;
  SamplerKind sampler_kind = SamplerKind::independent;
  std::uint32_t sampler_total = 1;
  Integrator integrator = Integrator::path;
  std::uint32_t light_sampling = 1;
  Mis mis = Mis::power;
  BsdfSampling bsdf_sampling = BsdfSampling::bsdf;
  std::uint32_t roulette = 1;
  std::uint32_t max_diffuse_depth = 0xffffffffu;
  std::uint32_t max_glossy_depth = 0xffffffffu;
  std::uint32_t max_specular_depth = 0xffffffffu;
  float clamp_direct = 0;
  float clamp_indirect = 0;
  float occlusion_length = 1e30f;
  std::uint32_t environment_texture = no_texture;
  std::uint32_t environment_light = no_light;
  std::uint32_t medium = no_medium;
  glm::vec3 environment_right{1, 0, 0};
  float shutter = 0;
  glm::vec3 environment_up{0, 1, 0};
  std::uint32_t terminator_offset = 0;
  glm::vec3 environment_forward{0, 0, -1};
  float reserved_1 = 0;
};
static_assert(sizeof(RenderConstants) == 224);

/// What differs between dispatches.
struct DispatchConstants {
  glm::uvec2 tile_offset{0};
  glm::uvec2 tile_size{1};
  std::uint32_t first_sample = 0;
  std::uint32_t sample_count = 1;
};
static_assert(sizeof(DispatchConstants) == 24);

}  // namespace tandem::pathtracer
