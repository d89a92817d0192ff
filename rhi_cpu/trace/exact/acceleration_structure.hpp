#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string_view>

#include "rhi/acceleration_structure.hpp"
#include "rhi_cpu/kernel/trace.hpp"
#include "rhi_cpu/trace/geometry_input.hpp"

/// Acceleration structures of the exact tracer, built from host memory. They copy what they need and keep no pointer to
/// it. Every hit that they report is the one that real numbers give: whether a ray meets a triangle or a box is decided
/// without rounding, and t and barycentrics are exact values rounded once, to the nearest float.
namespace tandem::cpu::exact {

struct BottomLevelScene;
struct TopLevelScene;

/// Geometries that instances refer to. In a box, an infinity counts as the largest float.
class BottomLevel {
 public:
  /// Throws rhi::Error, in the name of `label`, for spans shorter than the counts say and for an index that is not
  /// below vertex_count.
  static BottomLevel build(std::span<const GeometryInput> geometries, std::string_view label);

  /// Builds it anew, whatever has changed. Top levels that were built before keep what they were built with.
  /// Throws as build does, and is unchanged then.
  void update(std::span<const GeometryInput> geometries, std::string_view label);

  /// Memory that it takes; never 0.
  std::uint64_t bytes() const noexcept;

  const std::shared_ptr<const BottomLevelScene>& scene() const noexcept { return scene_; }

 private:
  explicit BottomLevel(std::shared_ptr<const BottomLevelScene> scene);

  std::shared_ptr<const BottomLevelScene> scene_;
};

/// The built bottom level at an InstanceDesc::blas_address, or null when there is none. Called during the build only.
using BottomLevelLookup = std::function<const BottomLevel*(std::uint64_t blas_address)>;

/// Instances of bottom levels, which it keeps alive as they were when it was built. An instance is inactive when its
/// blas_address is 0 and when its transform is not finite or, exactly, not invertible.
class TopLevel {
 public:
  /// Throws rhi::Error, in the name of `label`, for an address that `lookup` does not know.
  static TopLevel build(std::span<const rhi::InstanceDesc> instances, const BottomLevelLookup& lookup,
                        std::string_view label);

  ~TopLevel();
  TopLevel(TopLevel&&) noexcept;
  TopLevel& operator=(TopLevel&&) noexcept;

  /// What a kernel traces: the `data` of its Resource. The address stays the same for the life of this structure, also
  /// when it is moved.
  const kernel::TopLevel& view() const noexcept;

  /// Memory that it takes, without its bottom levels; never 0.
  std::uint64_t bytes() const noexcept;

 private:
  explicit TopLevel(std::unique_ptr<TopLevelScene> scene);

  std::unique_ptr<TopLevelScene> scene_;
};

}  // namespace tandem::cpu::exact
