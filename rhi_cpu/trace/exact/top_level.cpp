#include <cmath>
#include <cstring>
#include <utility>

#include "rhi_cpu/trace/affine_inverse.hpp"
#include "rhi_cpu/trace/exact/acceleration_structure.hpp"
#include "rhi_cpu/trace/exact/scene.hpp"
#include "rhi_cpu/trace/instance_input.hpp"

namespace tandem::cpu::exact {
namespace {

bool is_finite(const float (&m)[3][4]) {
  for (const auto& row : m) {
    for (const float element : row) {
      if (!std::isfinite(element)) return false;
    }
  }
  return true;
}

/// The instance stays inactive, with a bottom level of null, when its transform has no inverse.
void set_up_instance(const rhi::InstanceDesc& desc, std::size_t index, const BottomLevelLookup& lookup,
                     std::string_view label, kernel::Instance& instance, InstanceTraits& traits) {
  const InstanceInput input = read_instance(desc);
  instance = input.instance;
  const BottomLevel* bottom_level = find_bottom_level(input, index, lookup, label);
  if (bottom_level == nullptr || !is_finite(instance.object_to_world)) return;
  traits.transform = make_transform(instance.object_to_world);
  if (traits.transform.determinant_sign == 0) return;
  static_assert(sizeof(instance.world_to_object) == sizeof(AffineInverse::rows));
  std::memcpy(instance.world_to_object, inverse_of(instance.object_to_world).rows, sizeof(instance.world_to_object));
  traits.bottom_level = bottom_level->scene();
  traits.flags = input.flags;
  traits.mask = input.mask;
}

}  // namespace

TopLevel::TopLevel(std::unique_ptr<TopLevelScene> scene) : scene_(std::move(scene)) {}
TopLevel::~TopLevel() = default;
TopLevel::TopLevel(TopLevel&&) noexcept = default;
TopLevel& TopLevel::operator=(TopLevel&&) noexcept = default;

const kernel::TopLevel& TopLevel::view() const noexcept { return *scene_; }

std::uint64_t TopLevel::bytes() const noexcept {
  return sizeof(TopLevelScene) + scene_->traits.size() * (sizeof(kernel::Instance) + sizeof(InstanceTraits)) +
         scene_->active_instances.size() * sizeof(std::uint32_t) + scene_->bvh.bytes();
}

TopLevel TopLevel::build(std::span<const rhi::InstanceDesc> instances, const BottomLevelLookup& lookup,
                         std::string_view label) {
  auto result = std::make_unique<TopLevelScene>();
  result->instance_storage.resize(instances.size());
  result->traits.resize(instances.size());
  result->all_opaque = true;
  result->has_boxes = false;
  std::vector<Bounds> bounds;
  for (std::uint32_t i = 0; i < instances.size(); ++i) {
    InstanceTraits& traits = result->traits[i];
    set_up_instance(instances[i], i, lookup, label, result->instance_storage[i], traits);
    if (traits.bottom_level == nullptr || traits.bottom_level->primitives.empty()) continue;
    result->all_opaque = result->all_opaque && is_opaque(traits.flags, traits.bottom_level->all_opaque);
    result->has_boxes = result->has_boxes || traits.bottom_level->has_boxes;
    result->active_instances.push_back(i);
    bounds.push_back(to_world(traits.transform, traits.bottom_level->bvh.bounds()));
  }
  result->bvh = Bvh(bounds);
  result->functions = &exact_trace_functions;
  result->instances = result->instance_storage.data();
  result->instance_count = static_cast<std::uint32_t>(instances.size());
  return TopLevel(std::move(result));
}

}  // namespace tandem::cpu::exact
