#pragma once

#include <array>
#include <cstdint>
#include <random>
#include <vector>

#include "rhi/acceleration_structure.hpp"
#include "rhi_cpu/kernel/trace.hpp"
#include "rhi_cpu/trace/embree/acceleration_structure.hpp"

/// The truth that tracing is measured against: every triangle and box of every instance, in double precision, one after
/// the other.
namespace tandem::test {

using Triangle = std::array<float, 9>;    ///< three positions
using BoxCorners = std::array<float, 6>;  ///< minimum and maximum

/// Of triangles or of boxes.
struct SoupGeometry {
  std::vector<Triangle> triangles;
  bool opaque = true;
  std::vector<BoxCorners> boxes = {};
};

std::vector<cpu::GeometryInput> inputs_of(const std::vector<SoupGeometry>& geometries);

/// A scene as plain data. Instances name their bottom level by blas_address = index + 1.
struct Soup {
  std::vector<std::vector<SoupGeometry>> bottom_levels;
  std::vector<rhi::InstanceDesc> instances;
};

/// The same scene, built.
struct BuiltSoup {
  std::vector<cpu::BottomLevel> bottom_levels;
  cpu::TopLevel top_level;
};

BuiltSoup build(const cpu::EmbreeDevice& device, const Soup& soup, rhi::BuildFlags flags = rhi::BuildFlags::none);

/// A hit in double precision, with how far the same hit in single precision may be away from it.
struct ExactHit {
  double t;       ///< of a box: where the ray enters it, or t_min
  double t_exit;  ///< of a box: where the ray leaves it, or t_max
  double u, v;
  std::uint32_t instance_index, geometry_index, primitive_index;
  bool front_face;
  bool opaque;
  bool is_box;
  double t_tolerance;
  double uv_tolerance;
};

struct ExactHits {
  /// Some triangle or box is so close to being missed or hit, by an edge, by the ends of the ray or by its grazing
  /// angle, that single precision may decide otherwise. Nothing exact can be asked of such a ray.
  bool ambiguous = false;
  std::vector<ExactHit> hits;  ///< what mask and flags leave, nearest first
};

ExactHits all_hits(const Soup& soup, const kernel::Ray& ray);

/// An identity instance of bottom level `index` with mask 0xFF.
rhi::InstanceDesc instance_of(std::size_t index);

/// A scene of `geometry_count` geometries of `triangle_count` random triangles around the origin in each of two bottom
/// levels, of as many geometries of a few boxes in a third, and of rotated, scaled and mirrored instances with all
/// kinds of flags and masks, some of them inactive.
Soup random_soup(std::mt19937& random, std::size_t geometry_count, std::size_t triangle_count);

/// A ray from somewhere in or around random_soup, its direction of a length between 0.1 and 10.
kernel::Ray random_ray(std::mt19937& random, std::uint32_t flags, std::uint32_t mask);

}  // namespace tandem::test
