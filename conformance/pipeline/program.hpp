#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "conformance/kit/context.hpp"
#include "conformance/kit/scene.hpp"
#include "rhi/device.hpp"

/// Ray tracing pipelines from GLSL, and runs of them.
namespace tandem::conformance::pipeline {

/// GLSL of one hit group; an empty text is a shader that is not there.
struct HitGroupText {
  std::string closest_hit = {};
  std::string any_hit = {};
  std::string intersection = {};
};

/// GLSL of a pipeline. Before every text come `#version 460` and the extension GL_EXT_ray_tracing. What it binds in set
/// 0 is the binding's number in Launch.
struct PipelineText {
  std::vector<std::string> ray_generation = {};
  std::vector<std::string> miss = {};
  std::vector<HitGroupText> hit_groups = {};
  std::vector<std::string> callable = {};
  std::uint32_t max_recursion_depth = 1;
  std::vector<rhi::SpecializationValue> specialization = {};
};

/// The pipeline of these shaders, each compiled when a case first needs it.
rhi::RayTracingPipelineHandle make_pipeline(Context& context, const PipelineText& text, const std::string& label);

/// One record without data for each of `count` shaders.
rhi::ShaderRecords one_record_each(std::size_t count);

/// A record of `shader` without data.
inline rhi::ShaderRecord record_of(std::uint32_t shader) { return {.shader = shader, .data = {}}; }

/// A record of `shader` with the bytes of `data`.
template <typename T>
rhi::ShaderRecord record_with(std::uint32_t shader, const T& data) {
  const std::span<const std::byte> bytes = std::as_bytes(std::span(&data, 1));
  return {.shader = shader, .data = {bytes.begin(), bytes.end()}};
}

/// What a run of a pipeline needs.
struct Launch {
  rhi::AccelerationStructureHandle scene = {};    ///< binding 0, if a shader uses it
  std::vector<rhi::BufferHandle> buffers = {};    ///< bindings 1, 2, ... in this order, each if a shader uses it
  std::vector<rhi::TextureHandle> textures = {};  ///< bindings 8, 9, ... likewise
  rhi::TraceRaysDesc trace = {};                  ///< without table and bind groups
  rhi::ShaderRecords ray_generation = {};         ///< empty: one record for each shader of the kind
  rhi::ShaderRecords miss = {};                   ///< likewise
  rhi::ShaderRecords hit = {};                    ///< likewise
  rhi::ShaderRecords callable = {};               ///< likewise
};

rhi::ShaderTableHandle make_table(rhi::Device& device, const rhi::RayTracingPipelineHandle& pipeline,
                                  const Launch& launch);

/// A bind group for set 0 of the resources that the pipeline uses.
rhi::BindGroupHandle make_bind_group(rhi::Device& device, const rhi::PipelineHandle& pipeline, const Launch& launch);

/// Traces once and waits.
void run(rhi::Device& device, const rhi::RayTracingPipelineHandle& pipeline, const Launch& launch);

/// Makes the pipeline, traces once with a last buffer of `result_count` zeros, and returns what is in it.
template <typename T>
std::vector<T> results_of(Context& context, const PipelineText& text, Launch launch, std::size_t result_count,
                          const std::string& label) {
  rhi::Device& device = context.device();
  launch.buffers.push_back(buffer_of(device, std::vector<T>(result_count), label + ": results"));
  run(device, make_pipeline(context, text, label), launch);
  return rhi::read<T>(device, launch.buffers.back(), result_count);
}

}  // namespace tandem::conformance::pipeline
