#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "rhi_vulkan/range_allocator.hpp"
#include "rhi_vulkan/vulkan.hpp"

namespace tandem::vulkan {

/// What memory is for, which decides the memory type.
enum class MemoryKind {
  device,   ///< only the device touches it
  upload,   ///< the host writes it, the device reads it; mapped and coherent
  download  ///< the device writes it, the host reads it; mapped, coherent, cached where offered
};

struct MemoryBlock;
class MemoryAllocator;

/// A piece of device memory, given back when this is destroyed. The allocator must outlive it.
class MemoryAllocation {
 public:
  MemoryAllocation() = default;
  MemoryAllocation(MemoryAllocator& allocator, MemoryBlock& block, std::uint64_t offset, std::uint64_t size)
      : allocator_(&allocator), block_(&block), offset_(offset), size_(size) {}
  MemoryAllocation(MemoryAllocation&& other) noexcept { *this = std::move(other); }
  MemoryAllocation& operator=(MemoryAllocation&& other) noexcept;
  ~MemoryAllocation();

  vk::DeviceMemory memory() const;
  std::uint64_t offset() const noexcept { return offset_; }
  /// The first byte on the host; null for MemoryKind::device.
  std::byte* mapped() const;

 private:
  MemoryAllocator* allocator_ = nullptr;
  MemoryBlock* block_ = nullptr;
  std::uint64_t offset_ = 0;
  std::uint64_t size_ = 0;
};

/// Device memory for buffers and images, in blocks of one memory type each. Large pieces get a block of their own.
/// Thread-safe. Whoever allocates for an image asks for whole pages of bufferImageGranularity.
class MemoryAllocator {
 public:
  MemoryAllocator(const vk::raii::Device& device, const vk::PhysicalDeviceMemoryProperties& properties,
                  std::uint64_t max_allocation_size);
  ~MemoryAllocator();

  /// Throws rhi::Error(out_of_memory).
  MemoryAllocation allocate(const vk::MemoryRequirements& requirements, MemoryKind kind);

 private:
  friend class MemoryAllocation;

  std::uint32_t memory_type(std::uint32_t allowed_types, MemoryKind kind) const;
  std::unique_ptr<MemoryBlock> make_block(std::uint32_t type, std::uint64_t size, bool mapped) const;
  std::uint64_t block_size(std::uint32_t type) const;
  void free(MemoryBlock& block, std::uint64_t offset, std::uint64_t size);

  const vk::raii::Device& device_;
  vk::PhysicalDeviceMemoryProperties properties_;
  std::uint64_t max_allocation_size_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<MemoryBlock>> blocks_;
};

}  // namespace tandem::vulkan
