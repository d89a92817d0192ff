#pragma once

#include <cstdint>
#include <optional>

#include "rhi/acceleration_structure.hpp"
#include "rhi_cpu/device_state.hpp"
#include "rhi_cpu/trace/acceleration_structure.hpp"

namespace tandem::cpu {

/// A bottom level of the rhi. Its address is a number of the device's registry, not one of memory.
class BottomLevelStructure final : public rhi::AccelerationStructure {
 public:
  BottomLevelStructure(DeviceStateHandle device, const rhi::BottomLevelDesc& desc);
  ~BottomLevelStructure() override;

  std::uint64_t device_address() const override { return address_; }
  rhi::AccelerationStructureSizes sizes() const override { return {}; }

  const DeviceState& device() const noexcept { return *device_; }
  /// The desc it was created from, for its counts and formats: only buffers of transforms are kept.
  const rhi::BottomLevelDesc& created_from() const noexcept { return created_from_; }
  /// Reads the buffers, which are this device's. Throws Error, for indices out of range among others.
  void build(const rhi::BottomLevelDesc& desc);

 private:
  DeviceStateHandle device_;
  rhi::BottomLevelDesc created_from_;
  std::uint64_t address_;
};

/// A top level of the rhi.
class TopLevelStructure final : public rhi::AccelerationStructure {
 public:
  TopLevelStructure(DeviceStateHandle device, const rhi::TopLevelDesc& desc);

  std::uint64_t device_address() const override;
  rhi::AccelerationStructureSizes sizes() const override { return {}; }

  const DeviceState& device() const noexcept { return *device_; }
  /// The desc it was created from, without its buffer.
  const rhi::TopLevelDesc& created_from() const noexcept { return created_from_; }
  /// Reads the buffer, which is this device's. Throws Error for an instance that names no built bottom level.
  void build(const rhi::TopLevelDesc& desc);
  /// What a kernel traces; nullptr as long as it is not built.
  const kernel::TopLevel* view() const noexcept { return built_ ? &built_->view() : nullptr; }

 private:
  DeviceStateHandle device_;
  rhi::TopLevelDesc created_from_;
  std::optional<TopLevel> built_;
};

/// Throws Error unless every buffer that the desc names is this device's.
void check_owner(const rhi::BottomLevelDesc& desc, const DeviceState& device);
void check_owner(const rhi::TopLevelDesc& desc, const DeviceState& device);

}  // namespace tandem::cpu
