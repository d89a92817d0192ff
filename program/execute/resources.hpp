#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "program/job/job.hpp"
#include "rhi/device.hpp"

/// What the shaders of a job are bound to, on a device.
namespace tandem::program {

/// Each at the position that it has in the job.
struct Resources {
  std::vector<rhi::BufferHandle> buffers;
  std::vector<rhi::TextureHandle> images;
  std::vector<rhi::SamplerHandle> samplers;
  std::vector<rhi::AccelerationStructureHandle> bottom_levels;
  std::vector<rhi::AccelerationStructureHandle> top_levels;
};

/// All resources with their first contents. Not waited for. Throws rhi::Error, which names the one at fault.
Resources make_resources(rhi::Device& device, const Job& job);

/// A buffer of the job with these bytes. Not waited for.
rhi::BufferHandle make_buffer(rhi::Device& device, const Job& job, std::size_t index, std::span<const std::byte> bytes);

}  // namespace tandem::program
