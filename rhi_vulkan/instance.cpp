#include "rhi_vulkan/instance.hpp"

#include <algorithm>
#include <cstring>
#include <exception>
#include <string>
#include <utility>
#include <vector>

#include "rhi_vulkan/error.hpp"

namespace tandem::vulkan {
namespace {

constexpr const char* validation_layer = "VK_LAYER_KHRONOS_validation";

VKAPI_ATTR VkBool32 VKAPI_CALL forward_message(VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                                               VkDebugUtilsMessageTypeFlagsEXT types,
                                               const VkDebugUtilsMessengerCallbackDataEXT* data, void* callback) {
  rhi::Message message;
  message.severity =
      (severity & VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT) != 0 ? rhi::Severity::error : rhi::Severity::warning;
  message.source = (types & VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT) != 0 ? "vulkan validation" : "vulkan";
  message.text = data->pMessage != nullptr ? data->pMessage : "";
  (*static_cast<const rhi::MessageCallback*>(callback))(message);
  return VK_FALSE;  // the call that provoked the message goes on
}

vk::DebugUtilsMessengerCreateInfoEXT messenger_info(rhi::MessageCallback& on_message) {
  // Through the C structure: the type of the callback member differs between versions of Vulkan-Hpp.
  VkDebugUtilsMessengerCreateInfoEXT info = {};
  info.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT;
  info.messageSeverity =
      VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
  info.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_GENERAL_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT |
                     VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT;
  info.pfnUserCallback = forward_message;
  info.pUserData = &on_message;
  vk::DebugUtilsMessengerCreateInfoEXT result;
  result = info;
  return result;
}

vk::raii::Context open_loader() {
  try {
    return vk::raii::Context();
  } catch (const std::exception&) {
    throw rhi::Error(rhi::ErrorCode::no_such_device, "", "the Vulkan loader (libvulkan.so.1) is not installed");
  }
}

bool offers_debug_utils(const vk::raii::Context& loader) {
  const std::vector<vk::ExtensionProperties> extensions = loader.enumerateInstanceExtensionProperties();
  return std::any_of(extensions.begin(), extensions.end(), [](const vk::ExtensionProperties& extension) {
    return std::strcmp(extension.extensionName, VK_EXT_DEBUG_UTILS_EXTENSION_NAME) == 0;
  });
}

void require_validation_layer(const vk::raii::Context& loader) {
  const std::vector<vk::LayerProperties> layers = loader.enumerateInstanceLayerProperties();
  const bool installed = std::any_of(layers.begin(), layers.end(), [](const vk::LayerProperties& layer) {
    return std::strcmp(layer.layerName, validation_layer) == 0;
  });
  if (!installed)
    throw rhi::Error(rhi::ErrorCode::unsupported, "",
                     std::string("driver validation needs the layer ") + validation_layer +
                         ", which is not installed (Debian: vulkan-validationlayers)");
}

}  // namespace

Instance::Instance(bool driver_validation, rhi::MessageCallback on_message)
    : on_message_(std::move(on_message)), loader_(open_loader()) {
  try {
    names_objects_ = offers_debug_utils(loader_);
    std::vector<const char*> extensions;
    std::vector<const char*> layers;
    if (names_objects_) extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
    if (driver_validation) {
      require_validation_layer(loader_);
      layers.push_back(validation_layer);
    }

    const bool listens = names_objects_ && on_message_;
    const vk::DebugUtilsMessengerCreateInfoEXT messenger = messenger_info(on_message_);
    constexpr vk::ValidationFeatureEnableEXT synchronization =
        vk::ValidationFeatureEnableEXT::eSynchronizationValidation;
    const vk::ValidationFeaturesEXT validation_features = {.pNext = listens ? &messenger : nullptr,
                                                           .enabledValidationFeatureCount = 1,
                                                           .pEnabledValidationFeatures = &synchronization};
    const vk::ApplicationInfo application = {
        .pApplicationName = "tandem", .pEngineName = "tandem", .apiVersion = VK_API_VERSION_1_3};
    vk::InstanceCreateInfo info = {.pApplicationInfo = &application,
                                   .enabledLayerCount = static_cast<std::uint32_t>(layers.size()),
                                   .ppEnabledLayerNames = layers.data(),
                                   .enabledExtensionCount = static_cast<std::uint32_t>(extensions.size()),
                                   .ppEnabledExtensionNames = extensions.data()};
    // Without validation there is no messenger yet: the loader's message on a machine without drivers becomes the
    // error.
    if (driver_validation) info.pNext = &validation_features;
    instance_ = vk::raii::Instance(loader_, info);
    if (listens) messenger_ = vk::raii::DebugUtilsMessengerEXT(instance_, messenger);
  } catch (const vk::IncompatibleDriverError&) {
    throw rhi::Error(rhi::ErrorCode::no_such_device, "", "no Vulkan driver is installed");
  } catch (const vk::SystemError& error) {
    throw_error(static_cast<vk::Result>(error.code().value()), "", "create a Vulkan instance");
  }
}

}  // namespace tandem::vulkan
