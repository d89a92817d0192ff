#pragma once

#include "rhi/message.hpp"
#include "rhi_vulkan/vulkan.hpp"

namespace tandem::vulkan {

/// The Vulkan loader, a VkInstance for Vulkan 1.2 and, where a callback wants them, the messages of driver and layers.
class Instance {
 public:
  /// @param driver_validation turns the Khronos validation layer on, with synchronisation validation;
  /// Error(unsupported)
  ///   when it is not installed
  /// Throws Error(no_such_device) when there is no loader or no driver.
  Instance(bool driver_validation, rhi::MessageCallback on_message);
  Instance(const Instance&) = delete;
  Instance& operator=(const Instance&) = delete;

  const vk::raii::Instance& handle() const noexcept { return instance_; }
  /// Whether objects can be given names for messages and debuggers (VK_EXT_debug_utils).
  bool names_objects() const noexcept { return names_objects_; }

 private:
  rhi::MessageCallback on_message_;  // the driver holds its address
  vk::raii::Context loader_;
  bool names_objects_ = false;
  vk::raii::Instance instance_ = nullptr;
  vk::raii::DebugUtilsMessengerEXT messenger_ = nullptr;
};

}  // namespace tandem::vulkan
