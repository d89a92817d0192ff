#include "rhi_vulkan/descriptor_pool.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace tandem::vulkan {

/// One Vulkan descriptor pool and what is left in it.
struct DescriptorSet::Page {
  vk::raii::DescriptorPool pool;
  std::uint32_t sets = 0;
  DescriptorCounts free;
  bool fragmented = false;  // the driver refused although the counts fit; set until a set comes back
};

namespace {

constexpr std::uint32_t sets_per_page = 256;
constexpr DescriptorCounts usual_page = {
    .uniform_buffers = 256, .storage_buffers = 2048, .acceleration_structures = 256, .storage_images = 256};

bool fits(const DescriptorCounts& wanted, const DescriptorCounts& free) {
  return wanted.uniform_buffers <= free.uniform_buffers && wanted.storage_buffers <= free.storage_buffers &&
         wanted.acceleration_structures <= free.acceleration_structures && wanted.storage_images <= free.storage_images;
}

vk::raii::DescriptorPool make_pool(const vk::raii::Device& device, const DescriptorCounts& counts) {
  const std::array<vk::DescriptorPoolSize, 4> sizes = {
      vk::DescriptorPoolSize{vk::DescriptorType::eUniformBuffer, counts.uniform_buffers},
      vk::DescriptorPoolSize{vk::DescriptorType::eStorageBuffer, counts.storage_buffers},
      vk::DescriptorPoolSize{vk::DescriptorType::eAccelerationStructureKHR, counts.acceleration_structures},
      vk::DescriptorPoolSize{vk::DescriptorType::eStorageImage, counts.storage_images}};
  return device.createDescriptorPool({.flags = vk::DescriptorPoolCreateFlagBits::eFreeDescriptorSet,
                                      .maxSets = sets_per_page,
                                      .poolSizeCount = static_cast<std::uint32_t>(sizes.size()),
                                      .pPoolSizes = sizes.data()});
}

}  // namespace

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
  page_->free.uniform_buffers -= counts.uniform_buffers;
  page_->free.storage_buffers -= counts.storage_buffers;
  page_->free.acceleration_structures -= counts.acceleration_structures;
  page_->free.storage_images -= counts.storage_images;
}

DescriptorSet::~DescriptorSet() {
  const std::scoped_lock lock(pool_.mutex_);
  set_ = nullptr;
  page_->sets += 1;
  page_->free.uniform_buffers += counts_.uniform_buffers;
  page_->free.storage_buffers += counts_.storage_buffers;
  page_->free.acceleration_structures += counts_.acceleration_structures;
  page_->free.storage_images += counts_.storage_images;
  page_->fragmented = false;
}

DescriptorPool::DescriptorPool(const vk::raii::Device& device) : device_(device) {}

DescriptorPool::~DescriptorPool() = default;

DescriptorSet::Page& DescriptorPool::page_with_room(const DescriptorCounts& counts) {
  for (DescriptorSet::Page& page : pages_)
    if (page.sets > 0 && !page.fragmented && fits(counts, page.free)) return page;
  const DescriptorCounts size = {
      .uniform_buffers = std::max(usual_page.uniform_buffers, counts.uniform_buffers),
      .storage_buffers = std::max(usual_page.storage_buffers, counts.storage_buffers),
      .acceleration_structures = std::max(usual_page.acceleration_structures, counts.acceleration_structures),
      .storage_images = std::max(usual_page.storage_images, counts.storage_images)};
  pages_.push_back({.pool = make_pool(device_, size), .sets = sets_per_page, .free = size});
  return pages_.back();
}

}  // namespace tandem::vulkan
