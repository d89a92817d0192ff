#pragma once

#include <cstddef>
#include <vector>

#include "program/execute/resources.hpp"
#include "program/job/job.hpp"
#include "rhi/device.hpp"

/// The pipelines of a job on a device, with what they are bound to.
namespace tandem::program {

struct BoundPipeline {
  rhi::ComputePipelineHandle compute;         ///< of a ray tracing pipeline null
  rhi::RayTracingPipelineHandle ray_tracing;  ///< of a compute pipeline null
  std::vector<rhi::BindGroupHandle> bind_groups;
  std::vector<std::byte> push_constants;  ///< as many as the shaders declare
};

/// Each pipeline of the job, in their order. Throws rhi::Error, which names the shader or the pipeline.
std::vector<BoundPipeline> make_pipelines(rhi::Device& device, const Job& job, const Resources& resources);

/// Binds all pipelines anew, after a resource has been replaced.
void bind_again(rhi::Device& device, const Job& job, const Resources& resources, std::vector<BoundPipeline>& pipelines);

}  // namespace tandem::program
