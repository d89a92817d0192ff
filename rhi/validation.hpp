#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "rhi/device.hpp"

/// The rules of the interface, written once. Every backend calls these first, so that a broken rule is the same
/// Error(invalid_argument or unsupported), with the object's label, on every device.
namespace tandem::rhi::validation {

void check(const BufferDesc& desc);
void check(const BottomLevelDesc& desc, const DeviceInfo& device);
void check(const TopLevelDesc& desc, const DeviceInfo& device);
void check(const ComputePipelineDesc& desc, const DeviceInfo& device);
void check(const RayTracingPipelineDesc& desc, const DeviceInfo& device);
void check(const ShaderTableDesc& desc, const DeviceInfo& device);
void check(const TextureDesc& desc, const DeviceInfo& device);
void check(const SamplerDesc& desc);
void check(const BindGroupDesc& desc, const DeviceInfo& device);
void check(const QueryPoolDesc& desc);
/// What of a shader's interface no pipeline of the device can have, each as a sentence without a full stop: the part of
/// Device::refusals that does not depend on the backend.
std::vector<std::string> refusals(const ShaderModuleHandle& shader, const DeviceInfo& device);
void check(const DispatchDesc& desc, const DeviceInfo& device);
void check(const TraceRaysDesc& desc, const DeviceInfo& device);
/// Commands of a list: `list` is named in the error.
void check_upload(const CommandList& list, const BufferHandle& buffer, std::uint64_t offset, std::uint64_t size);
void check_copy(const CommandList& list, const BufferRange& source, const BufferRange& destination);
void check_fill(const CommandList& list, const BufferRange& range);
void check_build(const CommandList& list, const AccelerationStructureHandle& structure,
                 const BottomLevelDesc& created_from, const BottomLevelDesc& desc);
void check_build(const CommandList& list, const AccelerationStructureHandle& structure,
                 const TopLevelDesc& created_from, const TopLevelDesc& desc);
/// As check_build, with BuildFlags::allow_update and, of a top level, the same count.
void check_update(const CommandList& list, const AccelerationStructureHandle& structure,
                  const BottomLevelDesc& created_from, const BottomLevelDesc& desc);
void check_update(const CommandList& list, const AccelerationStructureHandle& structure,
                  const TopLevelDesc& created_from, const TopLevelDesc& desc);
void check_compaction(const AccelerationStructureHandle& source, BuildFlags flags, const std::string& label);
/// Of copy_to_texture and copy_from_texture: `range` is the buffer's side.
void check_texture_copy(const CommandList& list, const BufferRange& range, const TextureHandle& texture);
void check_timestamp(const CommandList& list, const QueryPoolHandle& pool, std::uint32_t index);
void check_download(const BufferHandle& buffer, std::uint64_t offset, std::uint64_t size);

}  // namespace tandem::rhi::validation
