#include "rhi_vulkan/context.hpp"

#include <utility>
#include <vector>

namespace tandem::vulkan {
namespace {

vk::raii::Device make_device(const PhysicalDevice& physical) {
  const EnabledFeatures& enabled = physical.features;
  vk::PhysicalDeviceAccelerationStructureFeaturesKHR acceleration_structure = {.accelerationStructure = VK_TRUE};
  vk::PhysicalDeviceRayQueryFeaturesKHR ray_query = {.rayQuery = VK_TRUE};
  vk::PhysicalDeviceRayTracingPipelineFeaturesKHR pipeline = {
      .rayTracingPipeline = VK_TRUE,
      .rayTracingPipelineTraceRaysIndirect = enabled.trace_rays_indirect,
      .rayTraversalPrimitiveCulling = enabled.primitive_culling};
  vk::PhysicalDeviceRobustness2FeaturesEXT robustness = {.nullDescriptor = VK_TRUE};
  const auto chain = [&acceleration_structure](auto& features) {
    features.pNext = std::exchange(acceleration_structure.pNext, &features);
  };
  if (enabled.ray_query) chain(ray_query);
  if (enabled.ray_tracing_pipeline) chain(pipeline);
  if (enabled.null_descriptor) chain(robustness);
  vk::PhysicalDeviceVulkan12Features vulkan12 = enabled.vulkan12;
  vulkan12.pNext = &acceleration_structure;
  vk::PhysicalDeviceVulkan11Features vulkan11 = enabled.vulkan11;
  vulkan11.pNext = &vulkan12;
  const vk::PhysicalDeviceFeatures2 features = {.pNext = &vulkan11, .features = enabled.core};

  const float priority = 1;
  const vk::DeviceQueueCreateInfo queue = {
      .queueFamilyIndex = physical.queue_family, .queueCount = 1, .pQueuePriorities = &priority};
  const std::vector<const char*> extensions = extensions_of(enabled);
  const vk::DeviceCreateInfo info = {.pNext = &features,
                                     .queueCreateInfoCount = 1,
                                     .pQueueCreateInfos = &queue,
                                     .enabledExtensionCount = static_cast<std::uint32_t>(extensions.size()),
                                     .ppEnabledExtensionNames = extensions.data()};
  return translating_errors(physical.info.name, "create the device",
                            [&] { return physical.handle.createDevice(info); });
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
