#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>

#include "rhi/device.hpp"
#include "rhi_vulkan/descriptor_pool.hpp"
#include "rhi_vulkan/error.hpp"
#include "rhi_vulkan/instance.hpp"
#include "rhi_vulkan/memory.hpp"
#include "rhi_vulkan/physical_device.hpp"
#include "rhi_vulkan/queue.hpp"
#include "rhi_vulkan/vulkan.hpp"

namespace tandem::vulkan {

/// What a device and everything made from it share. Objects hold it by shared pointer, so it outlives them all.
struct Context {
  Context(std::unique_ptr<Instance> instance, PhysicalDevice physical_device);
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  /// Gives a Vulkan-Hpp object the name that validation messages and debuggers show.
  template <typename Handle>
  void name(const Handle& handle, const std::string& label) const {
    using CType = typename Handle::CType;
    if (instance->names_objects() && !label.empty())
      set_name(Handle::objectType, reinterpret_cast<std::uint64_t>(static_cast<CType>(*handle)), label);
  }

  std::unique_ptr<Instance> instance;
  PhysicalDevice physical;
  vk::raii::Device device;
  MemoryAllocator memory;
  DescriptorPool descriptors;
  Queue queue;
  std::atomic<std::uint64_t> timestamp_epoch = 0;  ///< the tick from which timestamps are counted; 0: none read yet

 private:
  void set_name(vk::ObjectType type, std::uint64_t handle, const std::string& label) const;
};

using ContextHandle = std::shared_ptr<Context>;

/// The Vulkan object behind a handle of the interface. Throws rhi::Error(invalid_argument) naming `label` when it was
/// made by another device.
/// @param label of the object or command list that uses it
/// @param what the kind of object: "buffer"
template <typename Object, typename Interface>
Object& own(const std::shared_ptr<Interface>& handle, const ContextHandle& context, const std::string& label,
            const char* what) {
  auto* object = dynamic_cast<Object*>(handle.get());
  if (object == nullptr || object->context() != context)
    throw rhi::Error(rhi::ErrorCode::invalid_argument, label,
                     std::string("the ") + what + " belongs to another device");
  return *object;
}

}  // namespace tandem::vulkan
