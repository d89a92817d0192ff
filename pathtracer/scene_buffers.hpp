#pragma once

#include <cstddef>
#include <cstdint>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

/// The structures of shaders/scene.glsl, byte for byte (std430).
namespace tandem::pathtracer {

enum class MaterialModel : std::uint32_t { diffuse = 0, mirror = 1, dielectric = 2 };

inline constexpr std::uint32_t no_texture = 0xffffffffu;

struct GpuMaterial {
  glm::vec3 base_color;
  MaterialModel model;
  glm::vec3 emission;
  float ior;
  glm::vec3 reflectance;
  float opacity = 1;
  glm::vec3 transmittance;
  std::uint32_t alpha_texture = no_texture;
};
static_assert(sizeof(GpuMaterial) == 64);

struct GpuAlphaTexture {
  std::uint32_t first_texel;
  std::uint32_t width;
  std::uint32_t height;
};
static_assert(sizeof(GpuAlphaTexture) == 12);

struct GpuLight {
  std::uint32_t triangle;
  std::uint32_t alias;
  std::uint32_t threshold;
  float area_density;
};
static_assert(sizeof(GpuLight) == 16);

inline constexpr std::uint32_t triangle_smooth = 0x80000000u;

struct GpuTriangle {
  std::uint32_t vertices[3];
  std::uint32_t material;
};
static_assert(sizeof(GpuTriangle) == 16);

struct RenderConstants {
  glm::vec3 camera_position;
  std::uint32_t first_sample;
  glm::vec3 camera_right;
  std::uint32_t sample_count;
  glm::vec3 camera_up;
  std::uint32_t max_depth;
  glm::vec3 camera_forward;
  std::uint32_t seed;
  glm::vec3 background;
  std::uint32_t light_count;
  glm::uvec2 resolution;
  glm::uvec2 tile_offset;
  glm::uvec2 tile_size;
  std::uint32_t opaque_count;
};
static_assert(sizeof(RenderConstants) == 108 && offsetof(RenderConstants, resolution) == 80);

}  // namespace tandem::pathtracer
