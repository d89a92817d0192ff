#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "rhi/buffer.hpp"
#include "rhi/flags.hpp"

namespace tandem::rhi {

/// How a ray treats a geometry when neither the ray nor the instance overrides it.
/// Vulkan: VkGeometryFlagBitsKHR.
enum class GeometryFlags : std::uint32_t {
  none = 0,
  opaque = 1 << 0,               ///< no any-hit, no candidates: the closest hit commits by itself
  no_duplicate_any_hit = 1 << 1  ///< any-hit runs at most once per primitive
};
template <>
inline constexpr bool is_flags<GeometryFlags> = true;

/// How a position is stored. A vertex stride is a multiple of the size of one component.
enum class VertexFormat : std::uint32_t {
  float3,  ///< three 32-bit floats
  half3,   ///< three 16-bit floats
  snorm3   ///< three signed 16-bit integers n that mean max(n / 32767, -1)
};

/// Bytes of one position: 12 or 6.
std::uint32_t size_of(VertexFormat format);
/// Bytes of one component: 4 or 2.
std::uint32_t component_size_of(VertexFormat format);

enum class IndexFormat : std::uint32_t { none, uint16, uint32 };

/// Triangles of one geometry, in the object space of the structure they are built into.
struct TriangleGeometry {
  BufferRange vertices;  ///< positions, `vertex_format` each, `vertex_stride` bytes apart
  std::uint32_t vertex_count = 0;
  std::uint32_t vertex_stride = 12;
  VertexFormat vertex_format = VertexFormat::float3;
  BufferRange indices;  ///< empty: consecutive triples of vertices
  IndexFormat index_format = IndexFormat::none;
  std::uint32_t triangle_count = 0;
  BufferRange transform;  ///< empty, or one row-major 3x4 matrix of floats, applied at build time
  GeometryFlags flags = GeometryFlags::opaque;
};

/// Axis-aligned boxes, for which a shader computes the hit. A box with a NaN in its minimum is inactive.
struct AabbGeometry {
  BufferRange boxes;  ///< six floats each (minimum, maximum), `stride` bytes apart
  std::uint32_t box_count = 0;
  std::uint32_t stride = 24;  ///< at least 24, a multiple of 8
  GeometryFlags flags = GeometryFlags::opaque;
};

using Geometry = std::variant<TriangleGeometry, AabbGeometry>;

/// One instance, bit-equal to VkAccelerationStructureInstanceKHR, so that a shader may write it too.
struct InstanceDesc {
  float object_to_world[3][4];      ///< row-major affine transform
  std::uint32_t custom_index : 24;  ///< gl_InstanceCustomIndexEXT
  std::uint32_t mask : 8;           ///< hit only if (mask & ray mask) != 0; make_instance sets 0xFF
  std::uint32_t sbt_offset : 24;    ///< hit group offset, in records
  std::uint32_t flags : 8;          ///< InstanceFlags
  std::uint64_t blas_address;       ///< AccelerationStructure::device_address(); 0 makes the instance inactive
};
static_assert(sizeof(InstanceDesc) == 64);

/// Bits of InstanceDesc::flags. Vulkan: VkGeometryInstanceFlagBitsKHR.
enum class InstanceFlags : std::uint32_t {
  none = 0,
  triangle_facing_cull_disable = 1 << 0,
  triangle_flip_facing = 1 << 1,  ///< counter-clockwise instead of clockwise (in object space) is the front
  force_opaque = 1 << 2,
  force_no_opaque = 1 << 3
};
template <>
inline constexpr bool is_flags<InstanceFlags> = true;

/// What a build is made for. Vulkan: VkBuildAccelerationStructureFlagBitsKHR.
enum class BuildFlags : std::uint32_t {
  none = 0,
  allow_update = 1 << 0,       ///< update_bottom_level and update_top_level may be called
  allow_compaction = 1 << 1,   ///< Device::create_compacted may be called
  prefer_fast_trace = 1 << 2,  ///< not together with prefer_fast_build
  prefer_fast_build = 1 << 3
};
template <>
inline constexpr bool is_flags<BuildFlags> = true;

/// What to build a bottom level from. Building reads the buffers when the command executes; afterwards they are not
/// needed.
struct BottomLevelDesc {
  std::vector<Geometry> geometries;  ///< all triangles or all boxes; none: nothing to hit
  BuildFlags flags = BuildFlags::prefer_fast_trace;
  std::string label;
};

/// What to build a top level from.
struct TopLevelDesc {
  BufferRange instances;  ///< instance_count InstanceDesc, 64 bytes each, at an offset that is a multiple of 16
  std::uint32_t instance_count = 0;
  BuildFlags flags = BuildFlags::prefer_fast_trace;
  std::string label;
};

/// Memory of an acceleration structure in bytes. The scratch memory is the backend's business; this says what it takes.
struct AccelerationStructureSizes {
  std::uint64_t structure = 0;       ///< the structure itself; on the CPU known, and not 0, once it is built
  std::uint64_t build_scratch = 0;   ///< while it is built; 0 where the backend keeps no such memory
  std::uint64_t update_scratch = 0;  ///< while it is updated; 0 without BuildFlags::allow_update
};

/// A bottom level (geometries) or a top level (instances). Created from a desc for its size, usable once built by
/// CommandList::build_bottom_level or build_top_level. A top level keeps no bottom level alive: the caller does.
class AccelerationStructure {
 public:
  enum class Level { bottom, top };

  virtual ~AccelerationStructure() = default;
  AccelerationStructure(const AccelerationStructure&) = delete;
  AccelerationStructure& operator=(const AccelerationStructure&) = delete;

  Level level() const noexcept { return level_; }
  const std::string& label() const noexcept { return label_; }

  /// Never 0. Of a bottom level for InstanceDesc::blas_address, of a top level for accelerationStructureEXT(address) in
  /// a shader: it has to be built, and the caller keeps it alive.
  virtual std::uint64_t device_address() const = 0;
  virtual AccelerationStructureSizes sizes() const = 0;

 protected:
  AccelerationStructure(Level level, std::string label) : level_(level), label_(std::move(label)) {}

 private:
  Level level_;
  std::string label_;
};

using AccelerationStructureHandle = std::shared_ptr<AccelerationStructure>;

/// An active instance of `bottom_level` with mask 0xFF, no flags, custom index 0 and SBT offset 0.
/// @param object_to_world row-major 3x4; identity by default
InstanceDesc make_instance(const AccelerationStructure& bottom_level,
                           const std::array<float, 12>& object_to_world = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0});

}  // namespace tandem::rhi
