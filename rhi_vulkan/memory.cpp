#include "rhi_vulkan/memory.hpp"

#include <algorithm>
#include <optional>
#include <string>

#include "rhi_vulkan/error.hpp"

namespace tandem::vulkan {

struct MemoryBlock {
  std::uint32_t type = 0;
  bool dedicated = false;
  vk::raii::DeviceMemory memory = nullptr;
  std::byte* mapped = nullptr;  // stays mapped; freeing the memory unmaps it
  RangeAllocator ranges;
};

namespace {

using Property = vk::MemoryPropertyFlagBits;

struct Wish {
  vk::MemoryPropertyFlags required;
  vk::MemoryPropertyFlags preferred;
};

Wish wish_of(MemoryKind kind) {
  switch (kind) {
    case MemoryKind::upload:
      return {Property::eHostVisible | Property::eHostCoherent, {}};
    case MemoryKind::download:
      return {Property::eHostVisible | Property::eHostCoherent, Property::eHostCached};
    default:
      return {{}, Property::eDeviceLocal};
  }
}

/// Memory that vkAllocateMemory may give only under features that are off.
constexpr vk::MemoryPropertyFlags special =
    Property::eLazilyAllocated | Property::eProtected | Property::eDeviceCoherentAMD | Property::eDeviceUncachedAMD;

}  // namespace

MemoryAllocation& MemoryAllocation::operator=(MemoryAllocation&& other) noexcept {
  std::swap(allocator_, other.allocator_);
  std::swap(block_, other.block_);
  std::swap(offset_, other.offset_);
  std::swap(size_, other.size_);
  return *this;
}

MemoryAllocation::~MemoryAllocation() {
  if (block_ != nullptr) allocator_->free(*block_, offset_, size_);
}

vk::DeviceMemory MemoryAllocation::memory() const { return *block_->memory; }

std::byte* MemoryAllocation::mapped() const { return block_->mapped == nullptr ? nullptr : block_->mapped + offset_; }

MemoryAllocator::MemoryAllocator(const vk::raii::Device& device, const vk::PhysicalDeviceMemoryProperties& properties,
                                 std::uint64_t max_allocation_size)
    : device_(device), properties_(properties), max_allocation_size_(max_allocation_size) {}

MemoryAllocator::~MemoryAllocator() = default;

MemoryAllocation MemoryAllocator::allocate(const vk::MemoryRequirements& requirements, MemoryKind kind) {
  const std::uint64_t size = requirements.size;
  if (size > max_allocation_size_)
    throw rhi::Error(rhi::ErrorCode::out_of_memory, "",
                     std::to_string(size) + " bytes are more than the " + std::to_string(max_allocation_size_) +
                         " that the driver allocates at once");
  const std::uint32_t type = memory_type(requirements.memoryTypeBits, kind);
  const bool mapped = kind != MemoryKind::device;
  const std::scoped_lock lock(mutex_);
  const bool dedicated = size > block_size(type) / 2;
  if (!dedicated) {
    for (const std::unique_ptr<MemoryBlock>& block : blocks_) {
      if (block->type != type || block->dedicated || (mapped && block->mapped == nullptr)) continue;
      if (const std::optional<std::uint64_t> offset = block->ranges.allocate(size, requirements.alignment))
        return MemoryAllocation(*this, *block, *offset, size);
    }
  }
  std::unique_ptr<MemoryBlock> block = make_block(type, dedicated ? size : block_size(type), mapped);
  block->dedicated = dedicated;
  const std::uint64_t offset = block->ranges.allocate(size, requirements.alignment).value();
  blocks_.push_back(std::move(block));
  return MemoryAllocation(*this, *blocks_.back(), offset, size);
}

std::uint32_t MemoryAllocator::memory_type(std::uint32_t allowed_types, MemoryKind kind) const {
  const Wish wish = wish_of(kind);
  std::optional<std::uint32_t> acceptable;
  for (std::uint32_t i = 0; i < properties_.memoryTypeCount; ++i) {
    const vk::MemoryPropertyFlags flags = properties_.memoryTypes[i].propertyFlags;
    if ((allowed_types & (1u << i)) == 0 || (flags & special) || (flags & wish.required) != wish.required) continue;
    if ((flags & wish.preferred) == wish.preferred) return i;
    if (!acceptable) acceptable = i;
  }
  if (!acceptable) throw rhi::Error(rhi::ErrorCode::unsupported, "", "the driver has no memory type for it");
  return *acceptable;
}

std::unique_ptr<MemoryBlock> MemoryAllocator::make_block(std::uint32_t type, std::uint64_t size, bool mapped) const {
  const vk::MemoryAllocateFlagsInfo flags = {.flags = vk::MemoryAllocateFlagBits::eDeviceAddress};
  const vk::MemoryAllocateInfo info = {.pNext = &flags, .allocationSize = size, .memoryTypeIndex = type};
  return translating_errors("", "allocate " + std::to_string(size) + " bytes", [&] {
    auto block = std::make_unique<MemoryBlock>(
        MemoryBlock{.type = type, .memory = device_.allocateMemory(info), .ranges = RangeAllocator(size)});
    if (mapped) block->mapped = static_cast<std::byte*>(block->memory.mapMemory(0, VK_WHOLE_SIZE));
    return block;
  });
}

/// Large enough that the driver's limit on the number of allocations (4096 at least) is far, small beside the heap.
std::uint64_t MemoryAllocator::block_size(std::uint32_t type) const {
  constexpr std::uint64_t usual = 64ull << 20;
  const std::uint64_t heap = properties_.memoryHeaps[properties_.memoryTypes[type].heapIndex].size;
  return std::min({usual, heap / 16, max_allocation_size_});
}

void MemoryAllocator::free(MemoryBlock& block, std::uint64_t offset, std::uint64_t size) {
  const std::scoped_lock lock(mutex_);
  block.ranges.free(offset, size);
  if (!block.ranges.empty()) return;
  // One empty block of a type stays, so that a buffer made and destroyed in a loop does not allocate each time.
  const bool other_is_empty =
      std::any_of(blocks_.begin(), blocks_.end(), [&](const std::unique_ptr<MemoryBlock>& other) {
        return other.get() != &block && other->type == block.type && !other->dedicated && other->ranges.empty();
      });
  if (block.dedicated || other_is_empty)
    std::erase_if(blocks_, [&](const std::unique_ptr<MemoryBlock>& other) { return other.get() == &block; });
}

}  // namespace tandem::vulkan
