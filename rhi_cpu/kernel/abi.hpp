#pragma once

#include <cstddef>
#include <cstdint>

/// The boundary between rhi_cpu and a translated shader, which lives in a shared library of its own. Plain data and one
/// exported function; nothing here depends on GLM, Embree or the rest of Tandem.
namespace tandem::kernel {

/// Raised whenever something in kernel/ changes that a compiled kernel depends on.
inline constexpr std::uint32_t abi_version = 1;

/// One element of one binding. A buffer: its bytes. An acceleration structure: `data` points at a kernel::TopLevel.
struct Resource {
  std::byte* data = nullptr;
  std::uint64_t size = 0;  ///< bytes bound; 0 for an acceleration structure
};

/// One run of a kernel.
struct Dispatch {
  const Resource* resources = nullptr;  ///< KernelInfo::resource_count of them
  const std::byte* push_constants = nullptr;
  std::uint32_t workgroup_count[3] = {1, 1, 1};
};

enum class ResourceKind : std::uint32_t { uniform_buffer, storage_buffer, acceleration_structure };

/// Where a kernel expects a binding: elements [first_resource, first_resource + count) of Dispatch::resources.
struct BindingSlot {
  std::uint32_t set;
  std::uint32_t binding;
  std::uint32_t count;
  std::uint32_t first_resource;
  ResourceKind kind;
};

/// What a compiled kernel says of itself.
struct KernelInfo {
  std::uint32_t abi_version;
  std::uint32_t workgroup_size[3];  ///< after specialisation
  std::uint32_t push_constant_size;
  std::uint32_t resource_count;
  std::uint32_t binding_count;
  const BindingSlot* bindings;
  /// Runs workgroups [first, end) of the dispatch, counted with x fastest, then y, then z. Thread-safe.
  void (*run)(const Dispatch& dispatch, std::uint64_t first, std::uint64_t end);
};

/// The one symbol that a kernel library exports.
inline constexpr const char* entry_symbol = "tandem_kernel";
using EntryFunction = const KernelInfo* (*)();

}  // namespace tandem::kernel
