#pragma once

// Vulkan-Hpp as this folder uses it: no prototypes (libvulkan is opened at run time, so that programs start without
// it), plain aggregates with designated initialisers instead of constructors, and RAII handles that carry their own
// function tables, so that several devices live side by side without a global one.
#define VK_NO_PROTOTYPES 1
#define VULKAN_HPP_DISPATCH_LOADER_DYNAMIC 1
#define VULKAN_HPP_NO_CONSTRUCTORS 1

#include <vulkan/vulkan_raii.hpp>
