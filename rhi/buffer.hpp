#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "rhi/flags.hpp"

namespace tandem::rhi {

/// What a buffer may be bound or passed as. Every buffer can be copied from and to.
enum class BufferUsage : std::uint32_t {
  none = 0,
  storage = 1 << 0,                       ///< storage buffer in a bind group
  uniform = 1 << 1,                       ///< uniform buffer in a bind group
  acceleration_structure_input = 1 << 2,  ///< vertices, indices, boxes, transforms or instances of a build
  device_address = 1 << 3,                ///< device_address() may be called, and shaders may use the address
  indirect = 1 << 4,                      ///< DispatchDesc::indirect_count and TraceRaysDesc::indirect_size
  uniform_texels = 1 << 5,                ///< a TexelBuffer that shaders only read
  storage_texels = 1 << 6                 ///< a TexelBuffer that shaders write
};
template <>
inline constexpr bool is_flags<BufferUsage> = true;

struct BufferDesc {
  std::uint64_t size = 0;  ///< bytes, > 0
  BufferUsage usage = BufferUsage::storage;
  std::string label;  ///< names the buffer in every error about it
};

/// Memory on the device. Its contents are undefined until written, by CommandList::upload, fill, copy or a shader.
class Buffer {
 public:
  virtual ~Buffer() = default;
  Buffer(const Buffer&) = delete;
  Buffer& operator=(const Buffer&) = delete;

  const BufferDesc& desc() const noexcept { return desc_; }
  std::uint64_t size() const noexcept { return desc_.size; }

  /// Address for shaders and builds. Throws Error unless the usage has device_address or acceleration_structure_input.
  virtual std::uint64_t device_address() const = 0;

 protected:
  explicit Buffer(BufferDesc desc) : desc_(std::move(desc)) {}

 private:
  BufferDesc desc_;
};

using BufferHandle = std::shared_ptr<Buffer>;

inline constexpr std::uint64_t whole_size = ~std::uint64_t{0};

/// `size` bytes of a buffer from `offset` on; whole_size: up to its end. Empty when there is no buffer.
struct BufferRange {
  BufferHandle buffer;
  std::uint64_t offset = 0;
  std::uint64_t size = whole_size;

  bool empty() const noexcept { return buffer == nullptr; }
  /// The size with whole_size resolved. Only for ranges that are not empty and begin inside the buffer.
  std::uint64_t resolved_size() const noexcept { return size == whole_size ? buffer->size() - offset : size; }
};

}  // namespace tandem::rhi
