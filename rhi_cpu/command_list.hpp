#pragma once

#include <functional>
#include <string>
#include <vector>

#include "rhi/command_list.hpp"
#include "rhi_cpu/device_state.hpp"

namespace tandem::cpu {

/// Commands as functions, called one after the other when the list is submitted.
class CommandList final : public rhi::CommandList {
 public:
  CommandList(DeviceStateHandle device, std::string label);

  void upload(const rhi::BufferHandle& buffer, std::uint64_t offset, std::span<const std::byte> bytes) override;
  void copy(const rhi::BufferRange& source, const rhi::BufferRange& destination) override;
  void fill(const rhi::BufferRange& range, std::uint32_t value) override;
  void build_bottom_level(const rhi::AccelerationStructureHandle& structure, const rhi::BottomLevelDesc& desc) override;
  void build_top_level(const rhi::AccelerationStructureHandle& structure, const rhi::TopLevelDesc& desc) override;
  void update_bottom_level(const rhi::AccelerationStructureHandle& structure,
                           const rhi::BottomLevelDesc& desc) override;
  void update_top_level(const rhi::AccelerationStructureHandle& structure, const rhi::TopLevelDesc& desc) override;
  void copy_to_texture(const rhi::BufferRange& source, const rhi::TextureHandle& destination) override;
  void copy_from_texture(const rhi::TextureHandle& source, const rhi::BufferRange& destination) override;
  void dispatch(const rhi::DispatchDesc& desc) override;
  void trace_rays(const rhi::TraceRaysDesc& desc) override;
  void write_timestamp(const rhi::QueryPoolHandle& pool, std::uint32_t index) override;

  const DeviceState& device() const noexcept { return *device_; }
  /// Runs the commands. Nothing can be recorded afterwards, also when one of them throws.
  void execute();

 private:
  void record(std::function<void()> command);

  DeviceStateHandle device_;
  std::vector<std::function<void()>> commands_;
  bool submitted_ = false;
};

}  // namespace tandem::cpu
