#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "rhi/acceleration_structure.hpp"

/// Acceleration structures of a job, as values.
namespace tandem::program {

struct Triangles {
  std::vector<std::array<float, 3>> positions;  ///< object space
  std::vector<std::uint32_t> indices = {};      ///< three for each triangle; empty: consecutive triples of positions
  rhi::GeometryFlags flags = rhi::GeometryFlags::opaque;
};

struct Boxes {
  std::vector<std::array<float, 6>> boxes;  ///< minimum and maximum, object space
  rhi::GeometryFlags flags = rhi::GeometryFlags::opaque;
};

/// All geometries are triangles, or all are boxes.
struct BottomLevel {
  std::string name;
  std::vector<std::variant<Triangles, Boxes>> geometries;
};

struct Instance {
  std::size_t bottom_level = 0;
  std::array<float, 12> object_to_world = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};  ///< row-major 3x4
  std::uint32_t custom_index = 0;
  std::uint32_t mask = 0xff;
  std::uint32_t sbt_offset = 0;
  rhi::InstanceFlags flags = rhi::InstanceFlags::none;
};

struct TopLevel {
  std::string name;
  std::vector<Instance> instances;
};

}  // namespace tandem::program
