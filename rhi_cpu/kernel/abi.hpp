#pragma once

#include <cstddef>
#include <cstdint>

/// The boundary between rhi_cpu and a translated shader, which lives in a shared library of its own. Plain data and one
/// exported function; nothing here depends on GLM, Embree or the rest of Tandem.
namespace tandem::kernel {

/// Raised whenever something in kernel/ changes that a compiled kernel depends on.
inline constexpr std::uint32_t abi_version = 4;

/// One element of one binding. A buffer: its bytes. An acceleration structure: `data` points at a kernel::TopLevel, or
/// is null for one that no ray meets. An image or a texel buffer: `data` points at a kernel::Image, a sampler: at a
/// kernel::Sampler, both in one: at a kernel::SampledImage. `data` is null where nothing is bound.
struct Resource {
  std::byte* data = nullptr;
  std::uint64_t size = 0;  ///< bytes bound; 0 for what is no buffer
};

/// The most levels that an image has: a side of 2^15 texels.
inline constexpr std::uint32_t max_image_levels = 16;

/// Texels of an image, or of a texel buffer, which is an image of one dimension. A level is tightly packed: x fastest,
/// then y, then z, then layers and the six faces of a cube, which are layers.
struct Image {
  std::byte* texels = nullptr;
  /// Of level 0: its sides, then its layers (of a 1D array in size[1], else in size[2]); 1 where it has none.
  std::uint32_t size[3] = {1, 1, 1};
  std::uint32_t format = 0;                            ///< rhi::TextureFormat
  std::uint32_t sides = 3;                             ///< how many of `size` are halved from level to level
  std::uint32_t level_count = 1;                       ///< at least 1
  std::uint64_t level_offsets[max_image_levels] = {};  ///< of a level from `texels`, in bytes
};

/// The numbers of Vulkan's enumerations of the same names.
enum class Filter : std::uint32_t { nearest, linear };
enum class AddressMode : std::uint32_t {
  repeat,
  mirrored_repeat,
  clamp_to_edge,
  clamp_to_border,
  mirror_clamp_to_edge
};
enum class CompareOp : std::uint32_t {
  never,
  less,
  equal,
  less_or_equal,
  greater,
  not_equal,
  greater_or_equal,
  always
};
enum class BorderColor : std::uint32_t {
  float_transparent_black,
  int_transparent_black,
  float_opaque_black,
  int_opaque_black,
  float_opaque_white,
  int_opaque_white
};

/// VkSamplerCreateInfo, without anisotropy.
struct Sampler {
  Filter magnification = Filter::nearest;
  Filter minification = Filter::nearest;
  Filter mipmap = Filter::nearest;
  AddressMode address[3] = {AddressMode::repeat, AddressMode::repeat, AddressMode::repeat};  ///< u, v, w
  float lod_bias = 0.0f;
  float min_lod = 0.0f;
  float max_lod = 1000.0f;  ///< VK_LOD_CLAMP_NONE
  CompareOp compare = CompareOp::never;
  BorderColor border = BorderColor::float_transparent_black;
  std::uint32_t unnormalized = 0;  ///< coordinates are texels
};

/// A combined image sampler, and what a shader makes of an image and a sampler.
struct SampledImage {
  const Image* image = nullptr;
  const Sampler* sampler = nullptr;
};

/// What a kernel made for a device with a time limit asks now and then whether it may go on.
struct Watch {
  void (*look)(const Watch& watch);  ///< throws to end the launch
};

/// The fibres of a workgroup while they run: invocations (or subgroups) on stacks of their own, one of which runs at a
/// time, all on one thread. Who goes on when is the kernel's to say.
struct Fibres {
  /// Fibre `index` goes on, or begins, in place of the one that calls, which stays where it is until it is switched to.
  void (*switch_to)(Fibres& fibres, std::uint32_t index);
  /// Throws what ends a launch in which not all invocations of a workgroup reach the same barrier.
  void (*fail)(Fibres& fibres);
};

/// What fibre `index` does. @return the fibre that goes on when it has ended; their number when all have
using FibreFunction = std::uint32_t (*)(void* context, Fibres& fibres, std::uint32_t index);

/// Where fibres come from.
struct FibreHost {
  /// Runs function(context, fibres, 0), and the others as they are switched to, until one returns `count`; those that
  /// have not ended are dropped. What a fibre throws ends all of them and is thrown here.
  /// @param stack_size bytes that a fibre may need
  void (*run)(const FibreHost& host, std::uint32_t count, std::size_t stack_size, FibreFunction function,
              void* context);
};

/// One run of a kernel.
struct Dispatch {
  const Resource* resources = nullptr;  ///< KernelInfo::resource_count of them
  const std::byte* push_constants = nullptr;
  std::uint32_t workgroup_count[3] = {1, 1, 1};
  std::uint32_t base_workgroup[3] = {0, 0, 0};  ///< id of the first
  const Watch* watch = nullptr;                 ///< for kernels that look at it
  const FibreHost* fibres = nullptr;            ///< for kernels whose invocations wait for each other
};

/// rhi::BindingKind.
enum class ResourceKind : std::uint32_t {
  uniform_buffer,
  storage_buffer,
  acceleration_structure,
  storage_image,
  sampled_image,
  sampler,
  combined_image_sampler,
  uniform_texel_buffer,
  storage_texel_buffer
};

/// rhi::ShaderStage.
enum class Stage : std::uint32_t { compute, ray_generation, any_hit, closest_hit, miss, intersection, callable };

struct ShaderCall;

/// Where a kernel expects a binding: elements [first_resource, first_resource + count) of Dispatch::resources. An array
/// without a length has a count of 0 and one resource, whose `data` points at its elements and whose `size` is their
/// number.
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
