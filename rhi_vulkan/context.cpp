#include "rhi_vulkan/context.hpp"

#include <utility>

namespace tandem::vulkan {
namespace {

vk::raii::Device make_device(const PhysicalDevice& physical) {
  return translating_errors(physical.info.name, "create the device", [&] {
    return create_logical_device(physical.handle, physical.features, physical.queue_family);
  });
}

}  // namespace

Context::Context(std::unique_ptr<Instance> owned_instance, PhysicalDevice physical_device)
    : instance(std::move(owned_instance)),
      physical(std::move(physical_device)),
      device(make_device(physical)),
      memory(device, physical.handle.getMemoryProperties(), physical.max_allocation_size),
      descriptors(device),
      queue(device, physical.queue_family) {}

void Context::set_name(vk::ObjectType type, std::uint64_t handle, const std::string& label) const {
  device.setDebugUtilsObjectNameEXT({.objectType = type, .objectHandle = handle, .pObjectName = label.c_str()});
}

}  // namespace tandem::vulkan
