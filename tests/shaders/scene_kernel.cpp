#include "tests/shaders/scene_kernel.hpp"

#include <span>

#include <fmt/format.h>

#include "pathtracer/render/device_scene.hpp"
#include "tests/support/device_test.hpp"

namespace tandem::test {
namespace {

constexpr std::uint32_t workgroup_size = 64;

std::string source_of(const FunctionKernel& kernel) {
  return fmt::format(R"(#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_ray_query : require
layout(local_size_x = {}) in;
{}
layout(set = 1, binding = 2, std430) readonly buffer Inputs {{ uint values[]; }} inputs;
layout(set = 1, binding = 3, std430) buffer Outputs {{ uint values[]; }} outputs;
#define input_bits(k) inputs.values[gl_GlobalInvocationID.x * {} + (k)]
#define input_float(k) uintBitsToFloat(input_bits(k))
#define output_bits(k, value) outputs.values[gl_GlobalInvocationID.x * {} + (k)] = (value)
#define output_float(k, value) output_bits(k, floatBitsToUint(value))
void main() {{
  if (gl_GlobalInvocationID.x >= dispatch.tile_size.x) return;
{}
}}
)",
                     workgroup_size, kernel.includes, kernel.input_count, kernel.output_count, kernel.body);
}

}  // namespace

std::vector<std::uint32_t> run_bits(rhi::Device& device, const pathtracer::Scene& scene, const FunctionKernel& kernel,
                                    const std::vector<std::uint32_t>& inputs) {
  const auto rows = static_cast<std::uint32_t>(inputs.size() / kernel.input_count);
  const std::size_t output_count = std::size_t{rows} * kernel.output_count;
  const rhi::ComputePipelineHandle pipeline =
      compute_pipeline(device, source_of(kernel), "scene kernel", pathtracer::specialization(pathtracer::feature::all));
  const pathtracer::DeviceScene device_scene(device, scene);
  pathtracer::RenderConstants constants;
  device_scene.describe(constants);
  if (scene.environment) constants.background = scene.environment->radiance;
  const rhi::BufferHandle constants_buffer =
      buffer_of(device, std::vector<pathtracer::RenderConstants>{constants}, "render constants");
  const rhi::BufferHandle input_buffer = buffer_of(device, inputs, "inputs");
  const rhi::BufferHandle output_buffer =
      buffer_of(device, std::vector<std::uint32_t>(output_count, 0xdeadbeefu), "outputs");
  const std::vector<rhi::BindGroupHandle> groups = {
      device.create_bind_group({.pipeline = pipeline,
                                .set = 0,
                                .entries = device_scene.entries(pipeline->interface(), constants_buffer),
                                .label = "scene"}),
      device.create_bind_group({.pipeline = pipeline,
                                .set = 1,
                                .entries = {{.binding = 2, .resource = rhi::BufferRange{input_buffer}},
                                            {.binding = 3, .resource = rhi::BufferRange{output_buffer}}},
                                .label = "function kernel"})};
  pathtracer::DispatchConstants dispatch;
  dispatch.tile_size = {rows, 1};
  const rhi::CommandListHandle list = device.create_command_list("scene kernel");
  list->dispatch({.pipeline = pipeline,
                  .bind_groups = groups,
                  .push_constants = std::as_bytes(std::span(&dispatch, 1)),
                  .workgroup_count = {(rows + workgroup_size - 1) / workgroup_size, 1, 1}});
  device.submit(list)->wait();
  return contents<std::uint32_t>(device, output_buffer, output_count);
}

}  // namespace tandem::test
