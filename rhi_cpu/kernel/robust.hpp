#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "rhi_cpu/kernel/abi.hpp"
#include "rhi_cpu/kernel/memory.hpp"

/// Accesses that stay inside what is bound, for kernels of devices with robust access: what lies outside reads as zero
/// and is not written (Vulkan's robustBufferAccess2 and robustImageAccess2), byte by byte.
namespace tandem::kernel {

/// Bytes that an access of `extent` bytes at `offset` of `size` may touch.
constexpr std::size_t bytes_inside(std::size_t size, std::size_t offset, std::size_t extent) {
  if (offset >= size) return 0;
  return size - offset < extent ? size - offset : extent;
}

constexpr bool is_inside(std::size_t size, std::size_t offset, std::size_t extent) {
  return size >= extent && offset <= size - extent;
}

/// The `extent` bytes at `address`, with zeros for those outside. Apart from the kernel's own code, which must stay
/// small.
[[gnu::noinline, gnu::cold]] inline void copy_inside(std::byte* copy, std::size_t size, std::size_t offset,
                                                     const std::byte* address, std::size_t extent) {
  std::memset(copy, 0, extent);
  std::memcpy(copy, address, bytes_inside(size, offset, extent));
}

/// read(address), or the same of a copy that is zero where `address` leads out of the `size` bytes at `data`.
template <std::size_t extent, typename Read>
inline auto read_inside(const std::byte* data, std::size_t size, const std::byte* address, const Read& read) {
  const auto offset = static_cast<std::size_t>(address - data);
  std::byte copy[extent];
  if (!is_inside(size, offset, extent)) [[unlikely]] {
    copy_inside(copy, size, offset, address, extent);
    address = copy;
  }
  return read(address);
}

/// write(address), of which nothing gets out of the `size` bytes at `data`.
template <std::size_t extent, typename Write>
inline void write_inside(const std::byte* data, std::size_t size, std::byte* address, const Write& write) {
  const auto offset = static_cast<std::size_t>(address - data);
  if (is_inside(size, offset, extent)) [[likely]]
    return write(address);
  std::byte copy[extent];
  copy_inside(copy, size, offset, address, extent);
  write(static_cast<std::byte*>(copy));
  std::memcpy(address, copy, bytes_inside(size, offset, extent));
}

/// The same of values that lie in memory as C++ has them, which most are: a function for each type, where every lambda
/// above is one more for the compiler.
template <typename T>
inline T load_inside(const std::byte* data, std::size_t size, const std::byte* address) {
  return read_inside<sizeof(T)>(data, size, address, [](const std::byte* inside) { return load<T>(inside); });
}

template <typename T>
inline void store_inside(const std::byte* data, std::size_t size, std::byte* address, const T& value) {
  write_inside<sizeof(T)>(data, size, address, [&](std::byte* inside) { store<T>(inside, value); });
}

/// Stands for memory outside during one atomic operation.
struct Nowhere {
  alignas(8) std::byte bytes[8] = {};
};

template <std::size_t extent>
inline std::byte* pointer_inside(const std::byte* data, std::size_t size, std::byte* address, Nowhere&& nowhere) {
  return is_inside(size, static_cast<std::size_t>(address - data), extent) ? address : nowhere.bytes;
}

/// An element of an array of descriptors; nothing where it has none.
inline const Resource& element(const Resource* array, std::size_t count, std::size_t index) {
  static constexpr Resource nothing;
  return index < count ? array[index] : nothing;
}

/// What a descriptor that is not bound is: an image without texels, or for samplers one texel of zeros.
template <typename T>
inline const T* bound(const std::byte* data) {
  alignas(16) static constinit std::byte zeros[16] = {};
  static constexpr Image no_texels = {.texels = zeros, .size = {0, 0, 0}};
  static constexpr Image one_texel = {.texels = zeros};
  static constexpr Sampler sampler;
  static constexpr SampledImage sampled = {&one_texel, &sampler};
  if (data != nullptr) [[likely]]
    return reinterpret_cast<const T*>(data);
  if constexpr (std::is_same_v<T, SampledImage>)
    return &sampled;
  else if constexpr (std::is_same_v<T, Sampler>)
    return &sampler;
  else if constexpr (std::is_same_v<T, Image>)
    return &no_texels;
  else
    return nullptr;
}

/// An index into an array of the shader's own; 0 for one outside of it.
inline std::size_t index_inside(std::size_t count, std::size_t index) { return index < count ? index : 0; }

}  // namespace tandem::kernel
