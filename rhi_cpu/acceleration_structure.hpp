#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "rhi/acceleration_structure.hpp"
#include "rhi_cpu/device_state.hpp"
#include "rhi_cpu/tracer.hpp"

namespace tandem::cpu {

/// A bottom level of the rhi. Its address is a number of the device's registry, not one of memory.
///
/// No tracer of ours can shrink what it has built, so a compacted copy shares the memory of its source instead, which
/// is to take none, until one of the two changes.
class BottomLevelStructure final : public rhi::AccelerationStructure {
 public:
  BottomLevelStructure(DeviceStateHandle device, const rhi::BottomLevelDesc& desc);
  ~BottomLevelStructure() override;

  std::uint64_t device_address() const override { return address_; }
  rhi::AccelerationStructureSizes sizes() const override;

  const DeviceState& device() const noexcept { return *device_; }
  /// The desc it was created from, for its counts, formats and flags: only buffers of transforms are kept.
  const rhi::BottomLevelDesc& created_from() const noexcept { return created_from_; }
  /// Reads the buffers, which are this device's. Throws Error, for indices out of range among others.
  void build(const rhi::BottomLevelDesc& desc);
  /// As build, for what is built already. Throws Error when nothing is.
  void update(const rhi::BottomLevelDesc& desc);
  /// Throws Error when nothing is built. To be called while no command list executes.
  std::shared_ptr<BottomLevelStructure> compacted(std::string label) const;
  /// A copy can be updated, but not be built.
  bool is_compacted() const noexcept { return is_compacted_; }

 private:
  void set_built(std::shared_ptr<BuiltBottomLevel> built);

  DeviceStateHandle device_;
  rhi::BottomLevelDesc created_from_;
  std::uint64_t address_;
  std::shared_ptr<BuiltBottomLevel> built_;  ///< null as long as it is not built
  bool is_compacted_ = false;
};

/// A top level of the rhi. A compacted copy shares the memory of its source, as a bottom level's does.
class TopLevelStructure final : public rhi::AccelerationStructure {
 public:
  TopLevelStructure(DeviceStateHandle device, const rhi::TopLevelDesc& desc);

  std::uint64_t device_address() const override;
  rhi::AccelerationStructureSizes sizes() const override;

  const DeviceState& device() const noexcept { return *device_; }
  /// The desc it was created from, without its buffer.
  const rhi::TopLevelDesc& created_from() const noexcept { return created_from_; }
  /// Reads the buffer, which is this device's. Throws Error for an instance that names no built bottom level.
  void build(const rhi::TopLevelDesc& desc);
  /// Builds it anew, which is fast for instances. Throws Error when it was never built, or with another count.
  void update(const rhi::TopLevelDesc& desc);
  /// Throws Error when nothing is built. To be called while no command list executes.
  std::shared_ptr<TopLevelStructure> compacted(std::string label) const;
  /// A copy can be updated, but not be built.
  bool is_compacted() const noexcept { return is_compacted_; }
  /// What a kernel traces; nullptr as long as it is not built.
  const kernel::TopLevel* view() const noexcept { return built_ != nullptr ? &view_of(*built_) : nullptr; }

 private:
  DeviceStateHandle device_;
  rhi::TopLevelDesc created_from_;
  void set_built(std::shared_ptr<const BuiltTopLevel> built);

  std::shared_ptr<const BuiltTopLevel> built_;  ///< null as long as it is not built
  kernel::AddressedTopLevel addressed_;         ///< what device_address() points at
  bool is_compacted_ = false;
};

/// Throws Error unless every buffer that the desc names is this device's.
void check_owner(const rhi::BottomLevelDesc& desc, const DeviceState& device);
void check_owner(const rhi::TopLevelDesc& desc, const DeviceState& device);

}  // namespace tandem::cpu
