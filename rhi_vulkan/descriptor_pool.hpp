#pragma once

#include <array>
#include <cstdint>
#include <list>
#include <mutex>

#include "rhi_vulkan/vulkan.hpp"

namespace tandem::vulkan {

/// Descriptors of each kind that bind groups may hold.
struct DescriptorCounts {
  std::uint32_t uniform_buffers = 0;
  std::uint32_t storage_buffers = 0;
  std::uint32_t acceleration_structures = 0;
  std::uint32_t storage_images = 0;
};

class DescriptorPool;

/// A descriptor set, given back to its pool when this is destroyed. The pool must outlive it.
class DescriptorSet {
 public:
  DescriptorSet(DescriptorPool& pool, vk::DescriptorSetLayout layout, const DescriptorCounts& counts);
  DescriptorSet(const DescriptorSet&) = delete;
  DescriptorSet& operator=(const DescriptorSet&) = delete;
  ~DescriptorSet();

  const vk::raii::DescriptorSet& handle() const noexcept { return set_; }

 private:
  friend class DescriptorPool;
  struct Page;

  DescriptorPool& pool_;
  Page* page_ = nullptr;
  DescriptorCounts counts_;
  vk::raii::DescriptorSet set_ = nullptr;
};

/// Descriptor sets from Vulkan descriptor pools that are added as needed. Thread-safe.
class DescriptorPool {
 public:
  explicit DescriptorPool(const vk::raii::Device& device);
  ~DescriptorPool();

 private:
  friend class DescriptorSet;

  DescriptorSet::Page& page_with_room(const DescriptorCounts& counts);

  const vk::raii::Device& device_;
  std::mutex mutex_;
  std::list<DescriptorSet::Page> pages_;
};

}  // namespace tandem::vulkan
