#include "rhi_vulkan/descriptor_pool.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace tandem::vulkan {

/// One Vulkan descriptor pool and what is left in it.
struct DescriptorSet::Page {
  vk::raii::DescriptorPool pool;
  std::uint32_t sets = 0;
  DescriptorCounts free = {};
  bool fragmented = false;  // the driver refused although the counts fit; set until a set comes back
};

namespace {

constexpr std::uint32_t sets_per_page = 256;
constexpr std::uint32_t usual_count = 256;
constexpr std::uint32_t usual_storage_buffers = 2048;

bool fits(const DescriptorCounts& wanted, const DescriptorCounts& free) {
  for (std::size_t i = 0; i < wanted.size(); ++i)
    if (wanted[i] > free[i]) return false;
  return true;
}

vk::raii::DescriptorPool make_pool(const vk::raii::Device& device, const DescriptorCounts& counts) {
  std::array<vk::DescriptorPoolSize, descriptor_kind_count> sizes;
  for (std::size_t i = 0; i < sizes.size(); ++i)
    sizes[i] = {.type = descriptor_type(static_cast<rhi::BindingKind>(i)), .descriptorCount = counts[i]};
  return device.createDescriptorPool({.flags = vk::DescriptorPoolCreateFlagBits::eFreeDescriptorSet,
                                      .maxSets = sets_per_page,
                                      .poolSizeCount = static_cast<std::uint32_t>(sizes.size()),
                                      .pPoolSizes = sizes.data()});
}

}  // namespace

vk::DescriptorType descriptor_type(rhi::BindingKind kind) {
  switch (kind) {
    case rhi::BindingKind::uniform_buffer:
      return vk::DescriptorType::eUniformBuffer;
    case rhi::BindingKind::storage_buffer:
      return vk::DescriptorType::eStorageBuffer;
    case rhi::BindingKind::acceleration_structure:
      return vk::DescriptorType::eAccelerationStructureKHR;
    case rhi::BindingKind::storage_image:
      return vk::DescriptorType::eStorageImage;
    case rhi::BindingKind::sampled_image:
      return vk::DescriptorType::eSampledImage;
    case rhi::BindingKind::sampler:
      return vk::DescriptorType::eSampler;
    case rhi::BindingKind::combined_image_sampler:
      return vk::DescriptorType::eCombinedImageSampler;
    case rhi::BindingKind::uniform_texel_buffer:
      return vk::DescriptorType::eUniformTexelBuffer;
    case rhi::BindingKind::storage_texel_buffer:
      return vk::DescriptorType::eStorageTexelBuffer;
  }
  return vk::DescriptorType::eStorageBuffer;
}

DescriptorSet::DescriptorSet(DescriptorPool& pool, vk::DescriptorSetLayout layout, const DescriptorCounts& counts)
    : pool_(pool), counts_(counts) {
  const std::scoped_lock lock(pool_.mutex_);
  while (page_ == nullptr) {
    Page& page = pool_.page_with_room(counts);
    const vk::DescriptorSetAllocateInfo info = {
        .descriptorPool = *page.pool, .descriptorSetCount = 1, .pSetLayouts = &layout};
    try {
      set_ = std::move(pool_.device_.allocateDescriptorSets(info).front());
      page_ = &page;
    } catch (const vk::SystemError& error) {
      const auto result = static_cast<vk::Result>(error.code().value());
      const bool full = result == vk::Result::eErrorFragmentedPool || result == vk::Result::eErrorOutOfPoolMemory;
      if (!full || page.sets == sets_per_page) throw;
      page.fragmented = true;
    }
  }
  page_->sets -= 1;
  for (std::size_t i = 0; i < counts.size(); ++i) page_->free[i] -= counts[i];
}

DescriptorSet::~DescriptorSet() {
  const std::scoped_lock lock(pool_.mutex_);
  set_ = nullptr;
  page_->sets += 1;
  for (std::size_t i = 0; i < counts_.size(); ++i) page_->free[i] += counts_[i];
  page_->fragmented = false;
}

DescriptorPool::DescriptorPool(const vk::raii::Device& device) : device_(device) {}

DescriptorPool::~DescriptorPool() = default;

DescriptorSet::Page& DescriptorPool::page_with_room(const DescriptorCounts& counts) {
  for (DescriptorSet::Page& page : pages_)
    if (page.sets > 0 && !page.fragmented && fits(counts, page.free)) return page;
  DescriptorCounts size = counts;
  for (std::size_t i = 0; i < size.size(); ++i) {
    const bool is_storage_buffer = static_cast<rhi::BindingKind>(i) == rhi::BindingKind::storage_buffer;
    size[i] = std::max(size[i], is_storage_buffer ? usual_storage_buffers : usual_count);
  }
  pages_.push_back({.pool = make_pool(device_, size), .sets = sets_per_page, .free = size});
  return pages_.back();
}

}  // namespace tandem::vulkan
