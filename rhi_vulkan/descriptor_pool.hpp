#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <list>
#include <mutex>

#include "rhi/shader_reflection.hpp"
#include "rhi_vulkan/vulkan.hpp"

namespace tandem::vulkan {

/// Kinds of descriptors that bind groups may hold: those of rhi::BindingKind.
inline constexpr std::size_t descriptor_kind_count =
    static_cast<std::size_t>(rhi::BindingKind::storage_texel_buffer) + 1;

/// Descriptors by rhi::BindingKind.
using DescriptorCounts = std::array<std::uint32_t, descriptor_kind_count>;

/// The Vulkan type of a binding.
vk::DescriptorType descriptor_type(rhi::BindingKind kind);

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
