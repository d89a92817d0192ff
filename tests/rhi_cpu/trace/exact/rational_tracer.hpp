#pragma once

#include <array>
#include <cstdint>
#include <variant>
#include <vector>

#include <gmpxx.h>

#include "rhi/acceleration_structure.hpp"
#include "rhi_cpu/kernel/trace.hpp"
#include "rhi_cpu/trace/exact/acceleration_structure.hpp"

/// The truth that the exact tracer is measured against: every primitive of every instance, one after the other, in
/// rational numbers. It goes another way than the tracer: it inverts transforms and intersects in object space, by the
/// formula of Moeller and Trumbore (1997).
namespace tandem::test {

using Triangle = std::array<float, 9>;   ///< three positions
using BoxExtent = std::array<float, 6>;  ///< minimum, maximum

struct PrimitiveSet {
  std::variant<std::vector<Triangle>, std::vector<BoxExtent>> primitives;
  rhi::GeometryFlags flags = rhi::GeometryFlags::opaque;
};

/// A scene as plain data. Instances name their bottom level by blas_address = index + 1.
struct RationalScene {
  std::vector<std::vector<PrimitiveSet>> bottom_levels;
  std::vector<rhi::InstanceDesc> instances;
};

/// The same scene, built.
struct BuiltScene {
  std::vector<cpu::exact::BottomLevel> bottom_levels;
  cpu::exact::TopLevel top_level;
};

BuiltScene build(const RationalScene& scene);

/// What read_geometry takes; it refers to `sets`.
std::vector<cpu::GeometryInput> inputs_of(const std::vector<PrimitiveSet>& sets);

/// Everything that the ray meets and that its mask and flags leave, in the total order of hits, each number rounded
/// once, to the nearest float.
std::vector<kernel::Hit> all_hits(const RationalScene& scene, const kernel::Ray& ray);

/// The float nearest to a rational number, ties to even, infinity beyond the largest.
float nearest_float(const mpq_class& value);

/// An instance of bottom level `index` with mask 0xFF, at the origin.
rhi::InstanceDesc instance_of(std::size_t index);

}  // namespace tandem::test
