#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string_view>

#include "rhi/acceleration_structure.hpp"
#include "rhi_cpu/kernel/trace.hpp"
#include "rhi_cpu/trace/embree/embree_device.hpp"
#include "rhi_cpu/trace/geometry_input.hpp"

/// Acceleration structures over Embree, built from host memory. They copy what they need and keep no pointer to it.
namespace tandem::cpu {

struct BottomLevelScene;
struct TopLevelScene;

/// Geometries that instances refer to, all of triangles or all of boxes. A triangle with a coordinate beyond 1.8e18,
/// Embree's range, is never hit.
class BottomLevel {
 public:
  /// Throws rhi::Error, in the name of `label`, for spans shorter than the counts say, for an index that is not below
  /// vertex_count, for geometries of both kinds, and when memory runs out.
  static BottomLevel build(const EmbreeDevice& device, std::span<const GeometryInput> geometries, rhi::BuildFlags flags,
                           std::string_view label);

  /// Moves the primitives, and keeps the structure over them (a refit) where each that was active still is and no
  /// index has changed; a geometry of which that is not true is built anew. Top levels built before may not be traced
  /// from here on until they are built again.
  /// Throws rhi::Error, in the name of `label`, for what `build` does, without BuildFlags::allow_update at the build,
  /// and for geometries of another number, kind or count of primitives or vertices; nothing is changed then.
  void update(const EmbreeDevice& device, std::span<const GeometryInput> geometries, std::string_view label);

  /// Memory that it took when it was built, Embree's included; see EmbreeDevice::allocated_bytes.
  std::uint64_t bytes() const noexcept;

  std::shared_ptr<const BottomLevelScene> scene() const noexcept;

 private:
  explicit BottomLevel(std::shared_ptr<BottomLevelScene> scene);

  std::shared_ptr<BottomLevelScene> scene_;
};

/// The built bottom level at an InstanceDesc::blas_address, or null when there is none. Called during the build only.
using BottomLevelLookup = std::function<const BottomLevel*(std::uint64_t blas_address)>;

/// Instances of bottom levels, whose scenes it keeps alive. An instance is inactive when its
/// blas_address is 0, when its transform is not finite or cannot be inverted in single precision, and when the
/// transform or its inverse scales by more than 1e9 or moves by more than 1e17, which is beyond Embree's range. Rays
/// whose coordinates are beyond it in world or object space (1e18 / 4 divided by the largest inverse scale) hit
/// nothing.
class TopLevel {
 public:
  /// Throws rhi::Error, in the name of `label`, for an address that `lookup` does not know, and when memory runs out.
  static TopLevel build(const EmbreeDevice& device, std::span<const rhi::InstanceDesc> instances,
                        const BottomLevelLookup& lookup, rhi::BuildFlags flags, std::string_view label);

  ~TopLevel();
  TopLevel(TopLevel&&) noexcept;
  TopLevel& operator=(TopLevel&&) noexcept;

  /// Memory that it took when it was built, Embree's included, without the bottom levels; see
  /// EmbreeDevice::allocated_bytes.
  std::uint64_t bytes() const noexcept;

  /// What a kernel traces: the `data` of its Resource. The address stays the same for the life of this structure, also
  /// when it is moved.
  const kernel::TopLevel& view() const noexcept;

 private:
  explicit TopLevel(std::unique_ptr<TopLevelScene> scene);

  std::unique_ptr<TopLevelScene> scene_;
};

}  // namespace tandem::cpu
