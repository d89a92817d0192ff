#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "rhi_cpu/trace/affine_inverse.hpp"
#include "rhi_cpu/trace/embree/acceleration_structure.hpp"
#include "rhi_cpu/trace/embree/scene.hpp"
#include "rhi_cpu/trace/instance_input.hpp"

namespace tandem::cpu {
namespace {

// What Embree's single-precision inverse and its traversal can stand; see TopLevel.
constexpr double largest_scale = 1e9;
constexpr double largest_translation = 1e17;
constexpr float largest_coordinate = 0.25e18f;

bool is_in_range(const float (&m)[3][4]) {
  for (const auto& row : m) {
    for (int column = 0; column < 4; ++column) {
      if (!(std::abs(double{row[column]}) <= (column < 3 ? largest_scale : largest_translation))) return false;
    }
  }
  return true;
}

/// False when the transform is out of range, or when single precision could find its determinant to be zero.
bool invert(const float (&m)[3][4], float (&inverse)[3][4]) {
  if (!is_in_range(m)) return false;
  const AffineInverse result = inverse_of(m);
  // Four roundings of each product and sum, and a margin.
  if (!(std::abs(result.determinant) > 0x1p-20 * result.sum_of_magnitudes)) return false;
  std::memcpy(inverse, result.rows, sizeof(inverse));
  return is_in_range(inverse);
}

float coordinate_limit_of(const kernel::Instance& instance) {
  float scale = 1;
  for (const auto& row : instance.world_to_object) {
    for (int column = 0; column < 3; ++column) scale = std::max(scale, std::abs(row[column]));
  }
  return largest_coordinate / scale;
}

bool is_identity(const float (&m)[3][4]) {
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) {
      if (m[row][column] != (row == column ? 1.0f : 0.0f)) return false;
    }
  }
  return true;
}

/// The instance stays inactive, with a bottom level of null, when Embree cannot have its transform.
void set_up_instance(const rhi::InstanceDesc& desc, std::size_t index, const BottomLevelLookup& lookup,
                     std::string_view label, kernel::Instance& instance, InstanceTraits& traits) {
  const InstanceInput input = read_instance(desc);
  instance = input.instance;
  const BottomLevel* bottom_level = find_bottom_level(input, index, lookup, label);
  if (bottom_level == nullptr || !invert(instance.object_to_world, instance.world_to_object)) return;
  traits = {.bottom_level = bottom_level->scene(), .flags = input.flags, .mask = input.mask};
}

void attach_instance(const EmbreeDevice& device, RTCScene scene, std::uint32_t index, const kernel::Instance& instance,
                     const InstanceTraits& traits) {
  const GeometryPointer geometry(rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_INSTANCE));
  rtcSetGeometryInstancedScene(geometry.get(), traits.bottom_level->scene.get());
  rtcSetGeometryTransform(geometry.get(), 0, RTC_FORMAT_FLOAT3X4_ROW_MAJOR, instance.object_to_world);
  rtcSetGeometryMask(geometry.get(), traits.mask);
  rtcCommitGeometry(geometry.get());
  rtcAttachGeometryByID(scene, geometry.get(), index);
}

/// A scene of some of the instances of `level`.
TracedScene trace_together(const EmbreeDevice& device, const TopLevelScene& level,
                           std::span<const std::uint32_t> instances, RTCBuildQuality quality, std::string_view label) {
  TracedScene result;
  // An instance level costs 5 to 14 % of the time of a ray, and scenes of one instance at the origin are common.
  if (instances.size() == 1 && is_identity(level.instance_storage[instances[0]].object_to_world)) {
    result.direct = true;
    result.direct_instance = instances[0];
    result.scene = level.traits[instances[0]].bottom_level->scene.get();
    return result;
  }
  result.owned_scene = new_scene(device, quality, label);
  result.scene = result.owned_scene.get();
  for (const std::uint32_t i : instances)
    attach_instance(device, result.scene, i, level.instance_storage[i], level.traits[i]);
  rtcCommitScene(result.scene);
  device.check(label);
  return result;
}

}  // namespace

TopLevel::TopLevel(std::unique_ptr<TopLevelScene> scene) : scene_(std::move(scene)) {}
TopLevel::~TopLevel() = default;
TopLevel::TopLevel(TopLevel&&) noexcept = default;
TopLevel& TopLevel::operator=(TopLevel&&) noexcept = default;

const kernel::TopLevel& TopLevel::view() const noexcept { return *scene_; }

std::uint64_t TopLevel::bytes() const noexcept { return scene_->bytes; }

TopLevel TopLevel::build(const EmbreeDevice& device, std::span<const rhi::InstanceDesc> instances,
                         const BottomLevelLookup& lookup, rhi::BuildFlags flags, std::string_view label) {
  const std::int64_t allocated_before = device.allocated_bytes();
  auto result = std::make_unique<TopLevelScene>();
  result->instance_storage.resize(instances.size());
  result->traits.resize(instances.size());
  result->all_opaque = true;
  result->coordinate_limit = largest_coordinate;
  result->masks_in_filter = !device.has_ray_masks();
  std::vector<std::uint32_t> of_triangles, of_boxes;
  for (std::uint32_t i = 0; i < instances.size(); ++i) {
    InstanceTraits& traits = result->traits[i];
    set_up_instance(instances[i], i, lookup, label, result->instance_storage[i], traits);
    if (traits.bottom_level == nullptr) continue;
    (traits.bottom_level->holds_boxes ? of_boxes : of_triangles).push_back(i);
    result->coordinate_limit = std::min(result->coordinate_limit, coordinate_limit_of(result->instance_storage[i]));
    if (!traits.bottom_level->holds_boxes)
      result->all_opaque = result->all_opaque && is_opaque(traits.flags, traits.bottom_level->all_opaque);
  }
  result->has_boxes = !of_boxes.empty();
  // An update builds a top level anew, so only the speed of the build counts.
  const RTCBuildQuality quality =
      rhi::has(flags, rhi::BuildFlags::prefer_fast_build) ? RTC_BUILD_QUALITY_LOW : RTC_BUILD_QUALITY_MEDIUM;
  result->triangles = trace_together(device, *result, of_triangles, quality, label);
  if (result->has_boxes) result->boxes = trace_together(device, *result, of_boxes, quality, label);
  result->functions = &embree_trace_functions;
  result->instances = result->instance_storage.data();
  result->instance_count = static_cast<std::uint32_t>(instances.size());
  const std::int64_t allocated = std::max<std::int64_t>(device.allocated_bytes() - allocated_before, 0);
  result->bytes = sizeof(TopLevelScene) + instances.size() * (sizeof(kernel::Instance) + sizeof(InstanceTraits)) +
                  static_cast<std::uint64_t>(allocated);
  return TopLevel(std::move(result));
}

}  // namespace tandem::cpu
