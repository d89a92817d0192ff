#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string_view>
#include <variant>

#include "rhi_cpu/trace/embree/acceleration_structure.hpp"
#include "rhi_cpu/trace/exact/acceleration_structure.hpp"

namespace tandem::cpu {

/// A built structure of either tracer; all of one device are of the same.
using BuiltBottomLevel = std::variant<BottomLevel, exact::BottomLevel>;
using BuiltTopLevel = std::variant<TopLevel, exact::TopLevel>;

/// The built bottom level at an InstanceDesc::blas_address, or null when there is none.
using BuiltBottomLevelLookup = std::function<const BuiltBottomLevel*(std::uint64_t blas_address)>;

/// What a device traces rays with: Embree, or the exact tracer. Its functions throw what those of the tracers'
/// structures do.
class Tracer {
 public:
  enum class Kind { embree, exact };

  /// @param on_message hears what Embree reports
  Tracer(Kind kind, rhi::MessageCallback on_message);

  BuiltBottomLevel build_bottom_level(std::span<const GeometryInput> geometries, rhi::BuildFlags flags,
                                      std::string_view label) const;
  void update_bottom_level(BuiltBottomLevel& bottom_level, std::span<const GeometryInput> geometries,
                           std::string_view label) const;
  BuiltTopLevel build_top_level(std::span<const rhi::InstanceDesc> instances, const BuiltBottomLevelLookup& lookup,
                                rhi::BuildFlags flags, std::string_view label) const;

 private:
  std::optional<EmbreeDevice> embree_;  ///< nothing: the exact tracer
};

/// Memory that it takes.
std::uint64_t bytes_of(const BuiltBottomLevel& bottom_level);
std::uint64_t bytes_of(const BuiltTopLevel& top_level);

/// What a kernel traces.
const kernel::TopLevel& view_of(const BuiltTopLevel& top_level);

}  // namespace tandem::cpu
