#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string_view>

namespace tandem::cpu {

struct HostMemoryFree {
  void operator()(std::byte* memory) const;
};

/// What buffers and textures hold: bytes that begin at a cache line.
using HostMemory = std::unique_ptr<std::byte, HostMemoryFree>;

/// `size` bytes with undefined contents. Throws Error(out_of_memory) in the name of `label`, always for more than the
/// machine has.
/// @param what "a buffer", "a texture"
HostMemory allocate_host_memory(std::uint64_t size, std::string_view label, std::string_view what);

}  // namespace tandem::cpu
