#pragma once

#include <cstddef>
#include <cstdint>

/// The boundary between rhi_cpu and a translated shader, which lives in a shared library of its own. Plain data and one
/// exported function; nothing here depends on GLM, Embree or the rest of Tandem.
namespace tandem::kernel {

/// Raised whenever something in kernel/ changes that a compiled kernel depends on.
inline constexpr std::uint32_t abi_version = 2;

/// One element of one binding. A buffer: its bytes. An acceleration structure: `data` points at a kernel::TopLevel, or
/// is null for one that no ray meets. A storage image: `data` points at a kernel::Image.
struct Resource {
  std::byte* data = nullptr;
  std::uint64_t size = 0;  ///< bytes bound; 0 for an acceleration structure or image
};

/// Texels of a storage image, tightly packed: x fastest, then y, then z or the layer. How one is encoded the shader
/// knows (the format of the texture is checked against it when it is bound).
struct Image {
  std::byte* texels = nullptr;
  std::uint32_t size[3] = {1, 1, 1};
  std::uint32_t format = 0;  ///< rhi::TextureFormat, for shaders that name none
};

/// One run of a kernel.
struct Dispatch {
  const Resource* resources = nullptr;  ///< KernelInfo::resource_count of them
  const std::byte* push_constants = nullptr;
  std::uint32_t workgroup_count[3] = {1, 1, 1};
};

enum class ResourceKind : std::uint32_t { uniform_buffer, storage_buffer, acceleration_structure, storage_image };

/// rhi::ShaderStage.
enum class Stage : std::uint32_t { compute, ray_generation, any_hit, closest_hit, miss, intersection, callable };

struct ShaderCall;

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
  /// Compute: runs workgroups [first, end) of the dispatch, counted with x fastest, then y, then z. Thread-safe.
  void (*run)(const Dispatch& dispatch, std::uint64_t first, std::uint64_t end);
  Stage stage = Stage::compute;
  /// A ray tracing stage: runs the shader once (kernel/shader_call.hpp). Thread-safe.
  void (*call)(ShaderCall& call) = nullptr;
  std::uint32_t shader_record_size = 0;  ///< bytes of the shaderRecordEXT block, 0 without one
  std::uint32_t payload_size = 0;  ///< bytes of the incoming payload or callable data as C++ has it, 0 without one
};

/// The one symbol that a kernel library exports.
inline constexpr const char* entry_symbol = "tandem_kernel";
using EntryFunction = const KernelInfo* (*)();

}  // namespace tandem::kernel
