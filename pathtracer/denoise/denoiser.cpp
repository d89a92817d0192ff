#include "pathtracer/denoise/denoiser.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "base/error.hpp"
#include "denoise_shaders/spirv.hpp"
#include "rhi/transfer.hpp"

namespace tandem::pathtracer {
namespace {

/// DenoisePixel of shaders/denoise/pixel.glsl.
struct GpuPixel {
  glm::vec3 radiance;
  float depth;
  glm::vec3 variance;
  float coverage;
  glm::vec3 sampled_albedo;
  float reserved_0;
  glm::vec3 albedo;
  float reserved_1;
  glm::vec3 emission;
  float reserved_2;
  glm::vec3 normal;
  float reserved_3;
};
static_assert(sizeof(GpuPixel) == 96);

/// DenoiseConstants of the same.
struct GpuConstants {
  glm::uvec2 resolution;
  std::uint32_t step;
  float sigma_luminance;
  float sigma_depth;
  float sigma_albedo;
  float firefly_deviations;
  std::uint32_t reserved;
};
static_assert(sizeof(GpuConstants) == 32);

/// DenoiseGuide of shaders/denoise/guide.glsl.
constexpr std::size_t guide_size = 48;

constexpr std::uint32_t most_levels = 10;

bool is_finite(const glm::vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

/// Guides that are no numbers guide nothing.
GpuPixel gpu_pixel(const NoisyPicture& picture, std::size_t i) {
  GpuPixel pixel{.radiance = picture.radiance.pixels[i] - picture.sampled_emission[i],
                 .depth = picture.depth[i],
                 .variance = picture.variance[i],
                 .coverage = picture.coverage[i],
                 .sampled_albedo = picture.sampled_albedo[i],
                 .reserved_0 = 0,
                 .albedo = picture.albedo[i],
                 .reserved_1 = 0,
                 .emission = picture.emission[i],
                 .reserved_2 = 0,
                 .normal = picture.normal[i],
                 .reserved_3 = 0};
  if (!is_finite(pixel.albedo)) pixel.albedo = glm::vec3(0);
  if (!is_finite(pixel.sampled_albedo)) pixel.sampled_albedo = glm::vec3(0);
  if (!is_finite(pixel.emission)) pixel.emission = glm::vec3(0);
  if (!is_finite(pixel.normal)) pixel.normal = glm::vec3(0);
  if (!is_finite(pixel.variance)) pixel.variance = glm::vec3(-1);
  if (!std::isfinite(pixel.depth)) pixel.depth = 0;
  if (!(pixel.coverage >= 0 && pixel.coverage <= 1)) pixel.coverage = 0;
  return pixel;
}

void check_planes(const NoisyPicture& picture) {
  const std::size_t pixels = std::size_t{picture.radiance.width} * picture.radiance.height;
  if (pixels == 0) throw Error("a picture without pixels cannot be denoised");
  for (const std::size_t size : {picture.radiance.pixels.size(), picture.variance.size(), picture.sampled_albedo.size(),
                                 picture.sampled_emission.size(), picture.albedo.size(), picture.emission.size(),
                                 picture.normal.size(), picture.depth.size(), picture.coverage.size()})
    if (size != pixels)
      throw Error(fmt::format("the planes of a picture to denoise have {} and {} pixels", pixels, size));
}

rhi::ComputePipelineHandle pipeline(rhi::Device& device, std::span<const std::uint32_t> spirv, const char* label) {
  return device.create_compute_pipeline(
      {.shader = device.create_shader_module({spirv, label, true}), .specialization = {}, .label = "denoise"});
}

/// Records one pass over all pixels, with the buffers at bindings 0, 1, ... of set 0.
void record_pass(rhi::Device& device, rhi::CommandList& list, const rhi::ComputePipelineHandle& pipeline,
                 std::span<const rhi::BufferHandle> buffers, const GpuConstants& constants) {
  rhi::BindGroupDesc desc{.pipeline = pipeline, .set = 0, .entries = {}, .label = "denoise"};
  for (std::uint32_t binding = 0; binding < buffers.size(); ++binding)
    desc.entries.push_back({.binding = binding, .resource = rhi::BufferRange{buffers[binding]}});
  const auto groups = [](std::uint32_t pixels) { return (pixels + 7) / 8; };
  list.dispatch({.pipeline = pipeline,
                 .bind_groups = {device.create_bind_group(desc)},
                 .push_constants = std::as_bytes(std::span(&constants, 1)),
                 .workgroup_count = {groups(constants.resolution.x), groups(constants.resolution.y), 1}});
}

}  // namespace

void check(const DenoiseSettings& settings) {
  if (settings.levels > most_levels)
    throw Error(fmt::format("a denoiser has at most {} levels, not {}", most_levels, settings.levels));
  for (const float width : {settings.luminance_deviations, settings.depth_slopes, settings.albedo_difference})
    if (!(width >= 1e-6f && width <= 1e6f))
      throw Error(fmt::format("{} is no width of a denoiser's weights: they are from 1e-6 to 1e6", width));
  if (!(settings.firefly_deviations >= 0 && settings.firefly_deviations <= 1e6f))
    throw Error(fmt::format("{} is no number of deviations that make a firefly", settings.firefly_deviations));
}

Denoiser::Denoiser(rhi::DeviceHandle device)
    : device_(std::move(device)),
      prepare_(pipeline(*device_, denoise_shaders::denoise_prepare(), "denoise_prepare.comp")),
      filter_(pipeline(*device_, denoise_shaders::denoise_filter(), "denoise_filter.comp")),
      finish_(pipeline(*device_, denoise_shaders::denoise_finish(), "denoise_finish.comp")) {}

Image Denoiser::denoise(const NoisyPicture& picture, const DenoiseSettings& settings) {
  check(settings);
  check_planes(picture);
  const std::size_t count = picture.radiance.pixels.size();
  std::vector<GpuPixel> values;
  values.reserve(count);
  for (std::size_t i = 0; i < count; ++i) values.push_back(gpu_pixel(picture, i));

  const auto storage = [&](std::size_t size, const char* label) {
    return device_->create_buffer({.size = count * size, .usage = rhi::BufferUsage::storage, .label = label});
  };
  const rhi::BufferHandle guides = storage(guide_size, "denoise: guides");
  const rhi::BufferHandle result = storage(sizeof(glm::vec3), "denoise: picture");
  std::array<rhi::BufferHandle, 2> signals = {storage(sizeof(glm::vec4), "denoise: signal"),
                                              storage(sizeof(glm::vec4), "denoise: filtered signal")};
  GpuConstants constants{.resolution = {picture.radiance.width, picture.radiance.height},
                         .step = 1,
                         .sigma_luminance = settings.luminance_deviations,
                         .sigma_depth = settings.depth_slopes,
                         .sigma_albedo = settings.albedo_difference,
                         .firefly_deviations = settings.firefly_deviations,
                         .reserved = 0};
  const rhi::CommandListHandle list = device_->create_command_list("denoise");
  const rhi::BufferHandle pixels =
      rhi::create_filled(*device_, *list, values, rhi::BufferUsage::storage, "denoise: pixels");
  record_pass(*device_, *list, prepare_, std::array{pixels, guides, signals[0]}, constants);
  for (std::uint32_t level = 0; level < settings.levels; ++level) {
    constants.step = 1u << level;
    record_pass(*device_, *list, filter_, std::array{guides, signals[0], signals[1]}, constants);
    std::swap(signals[0], signals[1]);
  }
  record_pass(*device_, *list, finish_, std::array{pixels, signals[0], result}, constants);
  device_->submit(list)->wait();
  return {picture.radiance.width, picture.radiance.height, rhi::read<glm::vec3>(*device_, result, count)};
}

}  // namespace tandem::pathtracer
