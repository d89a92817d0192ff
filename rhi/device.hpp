#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "rhi/acceleration_structure.hpp"
#include "rhi/bind_group.hpp"
#include "rhi/buffer.hpp"
#include "rhi/command_list.hpp"
#include "rhi/compute_pipeline.hpp"
#include "rhi/error.hpp"
#include "rhi/fence.hpp"
#include "rhi/message.hpp"
#include "rhi/query_pool.hpp"
#include "rhi/ray_tracing_pipeline.hpp"
#include "rhi/sampler.hpp"
#include "rhi/shader_module.hpp"
#include "rhi/shader_table.hpp"
#include "rhi/texture.hpp"

namespace tandem::rhi {

enum class DeviceKind { discrete_gpu, integrated_gpu, virtual_gpu, cpu };

/// What a device can do beyond buffers and compute. Each is a bit of its own: real devices have one without the other.
struct Capabilities {
  bool ray_query = false;             ///< VK_KHR_ray_query
  bool ray_tracing_pipeline = false;  ///< VK_KHR_ray_tracing_pipeline
  bool position_fetch = false;        ///< VK_KHR_ray_tracing_position_fetch
  bool trace_rays_indirect = false;   ///< TraceRaysDesc::indirect_size
  bool primitive_culling = false;     ///< ray flags SkipTriangles and SkipAABBs in pipelines; ray queries have them
  bool null_acceleration_structure = false;  ///< a bind group may hold a null AccelerationStructureHandle
  bool buffer_references = false;            ///< GL_EXT_buffer_reference, with Buffer::device_address
  bool non_uniform_indexing = false;         ///< GL_EXT_nonuniform_qualifier on arrays of every kind of descriptor
  bool unsized_arrays = false;               ///< arrays of descriptors without a length
  bool partially_bound = false;              ///< a bind group may leave out elements of an array
  bool cube_arrays = false;                  ///< samplerCubeArray, imageCubeArray
  bool scalar_block_layout = false;          ///< GL_EXT_scalar_block_layout
  bool shader_int8 = false;                  ///< arithmetic and storage buffers
  bool shader_int16 = false;                 ///< likewise
  bool shader_int64 = false;
  bool shader_float16 = false;  ///< arithmetic and storage buffers
  bool shader_float64 = false;
  bool timestamps = false;  ///< QueryPool

  // GLSL's `shared`, of which there are Limits::workgroup_memory_size bytes.
  bool zeroed_workgroup_memory = false;        ///< variables with an initializer: GL_EXT_null_initializer
  bool workgroup_memory_layout = false;        ///< GL_EXT_shared_memory_block: blocks, which share their memory
  bool workgroup_memory_layout_8bit = false;   ///< 8-bit members of such blocks
  bool workgroup_memory_layout_16bit = false;  ///< 16-bit members of such blocks
  bool shared_int64_atomics = false;
  bool shared_float32_atomics = false;  ///< load, store and exchange
  bool shared_float32_atomic_add = false;
  bool shared_float32_atomic_min_max = false;
  bool shared_float64_atomic_add = false;

  // What compute shaders may do with their subgroups: SPIR-V's GroupNonUniform and the capabilities that continue it.
  bool subgroup_basic = false;  ///< gl_SubgroupSize and the other built-ins, subgroupElect, subgroupBarrier
  bool subgroup_vote = false;
  bool subgroup_arithmetic = false;
  bool subgroup_ballot = false;
  bool subgroup_shuffle = false;
  bool subgroup_shuffle_relative = false;
  bool subgroup_clustered = false;
  bool subgroup_quad = false;
  bool subgroup_rotate = false;                ///< GL_KHR_shader_subgroup_rotate
  bool subgroup_clustered_rotate = false;      ///< likewise, subgroupClusteredRotate
  bool subgroup_extended_types = false;        ///< operations on integers of 8, 16 and 64 bits and on floats of 16
  bool required_subgroup_size = false;         ///< ComputePipelineDesc::required_subgroup_size
  bool full_subgroups = false;                 ///< ComputePipelineDesc::full_subgroups
  bool subgroup_uniform_control_flow = false;  ///< GL_EXT_subgroup_uniform_control_flow
  bool maximal_reconvergence = false;          ///< GL_EXT_maximal_reconvergence
};

struct Limits {
  std::uint32_t max_push_constant_size = 128;
  std::uint64_t max_storage_buffer_range = 1ull << 27;
  std::uint64_t max_uniform_buffer_range = 16384;
  std::uint64_t storage_buffer_offset_alignment = 1;
  std::uint64_t uniform_buffer_offset_alignment = 1;
  std::uint64_t texel_buffer_offset_alignment = 1;
  std::uint64_t max_texel_buffer_elements = 1 << 16;
  std::array<std::uint32_t, 3> max_workgroup_size = {128, 128, 64};
  std::uint32_t max_workgroup_invocations = 128;
  std::uint32_t workgroup_memory_size = 0;    ///< bytes of shared variables of a workgroup; 0: there are none
  std::uint32_t subgroup_size = 1;            ///< gl_SubgroupSize where the device does not choose it by the shader
  std::uint32_t min_subgroup_size = 1;        ///< that the device chooses, or that a pipeline may require
  std::uint32_t max_subgroup_size = 1;        ///< likewise
  std::uint32_t max_workgroup_subgroups = 0;  ///< of a pipeline that requires a size
  std::array<std::uint32_t, 3> max_workgroup_count = {65535, 65535, 65535};
  std::uint32_t max_bind_groups = 4;
  std::uint64_t max_geometry_count = 0;   ///< per bottom level
  std::uint64_t max_primitive_count = 0;  ///< per bottom level
  std::uint64_t max_instance_count = 0;   ///< per top level
  std::uint32_t max_ray_recursion_depth = 0;
  std::uint64_t max_ray_invocations = 0;  ///< of one trace_rays
  std::uint32_t shader_record_alignment = 0;
  std::uint32_t max_shader_record_stride = 0;
  std::uint32_t shader_handle_size = 0;  ///< of a record, before its data
  std::uint32_t max_hit_attribute_size = 0;
  std::array<std::uint32_t, 7> max_texture_size = {};  ///< of a side, by TextureDimension
  std::uint32_t max_texture_layers = 0;
};

/// What is known of a device before it is created, and what `tandem devices` prints.
struct DeviceInfo {
  std::string name;         ///< what create_device takes: "cpu", "vulkan:0"
  std::string backend;      ///< "cpu", "vulkan"
  std::string description;  ///< the hardware: "NVIDIA GeForce RTX 2070 SUPER", "llvmpipe (LLVM 19.1.7, 256 bits)"
  std::string driver;       ///< name and version of what executes: "llvmpipe Mesa 25.0.7", "Embree 3.13.5"
  std::string api;          ///< "Vulkan 1.4.305"; "" on the CPU
  DeviceKind kind = DeviceKind::cpu;
  Capabilities capabilities;
  Limits limits;
  std::array<FormatSupport, texture_format_count> formats = {};  ///< by TextureFormat
  std::vector<std::uint32_t> spirv_capabilities = {};            ///< that shaders may declare, ascending
};

struct DeviceDesc {
  /// "cpu", "cpu-scalar" (the same with one lane), "cpu-exact", "vulkan" (the first that qualifies) or "vulkan:N"
  std::string name = "cpu";
  bool driver_validation = false;   ///< Vulkan: the Khronos validation layer, an error when it is not installed
  MessageCallback on_message = {};  ///< warnings, driver and validation messages
  /// What a shader accesses outside of a buffer, an image or an array of descriptors reads as zero and is not written,
  /// as Vulkan's robustBufferAccess2 and robustImageAccess2 say, where a Vulkan driver has these features. Without it
  /// such an access may do anything. CPU: of kernels that are compiled at run time, and of a shader's own arrays too,
  /// an index outside of which is 0; not of buffer references and pointers that are passed on as values.
  bool robust_access = true;
  /// CPU: a launch that takes longer is stopped in the next round of a loop, and submit throws Error(timeout); what it
  /// has written stays. 0: no limit. A Vulkan driver has a limit of its own, or none.
  std::chrono::milliseconds time_limit{0};
  /// CPU: gl_SubgroupSize, a power of two up to 32; 0: 8.
  std::uint32_t subgroup_size = 0;
  /// CPU: invocations that a compute kernel compiled at run time runs at once, in SIMD registers: 4, 8, 16 or 32, or 1,
  /// one after the other. A kernel with subgroup operations has its subgroup's size in place of any number but 1. 0:
  /// the device chooses. Results are the same.
  std::uint32_t lanes = 0;
  /// CPU: large kernels compiled at run time (of more than 2^14 words of SPIR-V) are not optimised. The compiler takes
  /// a fiftieth of the time, and they run up to 18 times as long. Results are the same.
  bool quick_kernels = false;
  std::uint32_t thread_count = 0;           ///< CPU: worker threads, 0 for all that the machine has
  std::filesystem::path kernel_cache = {};  ///< CPU: folder of kernels compiled at run time; empty: $TANDEM_CACHE_DIR,
                                            ///< else $XDG_CACHE_HOME/tandem, else ~/.cache/tandem
};

/// A device and all that is made from it. Objects may be created from several threads at once; a command list is
/// recorded by one thread at a time. Submissions execute in the order in which they are submitted. Objects keep the
/// device's own state alive, so they may outlive the Device. Every create function throws Error; labels name the object
/// in it.
class Device {
 public:
  virtual ~Device() = default;
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  const DeviceInfo& info() const noexcept { return info_; }

  virtual BufferHandle create_buffer(const BufferDesc& desc) = 0;
  virtual AccelerationStructureHandle create_bottom_level(const BottomLevelDesc& desc) = 0;
  virtual AccelerationStructureHandle create_top_level(const TopLevelDesc& desc) = 0;
  /// A built copy of a built structure in less memory, at another address. Waits for everything submitted. `source`
  /// has BuildFlags::allow_compaction; the copy has the flags of `source` and may be updated if `source` may.
  virtual AccelerationStructureHandle create_compacted(const AccelerationStructureHandle& source,
                                                       std::string label) = 0;
  virtual TextureHandle create_texture(const TextureDesc& desc) = 0;
  virtual SamplerHandle create_sampler(const SamplerDesc& desc) = 0;
  virtual ShaderModuleHandle create_shader_module(const ShaderModuleDesc& desc) = 0;
  /// Every reason why a pipeline of the shader cannot be made here, each a sentence without a full stop; none where it
  /// can. Compiles nothing.
  virtual std::vector<std::string> refusals(const ShaderModuleHandle& shader) const = 0;
  virtual ComputePipelineHandle create_compute_pipeline(const ComputePipelineDesc& desc) = 0;
  virtual RayTracingPipelineHandle create_ray_tracing_pipeline(const RayTracingPipelineDesc& desc) = 0;
  virtual ShaderTableHandle create_shader_table(const ShaderTableDesc& desc) = 0;
  virtual BindGroupHandle create_bind_group(const BindGroupDesc& desc) = 0;
  virtual QueryPoolHandle create_query_pool(const QueryPoolDesc& desc) = 0;
  virtual CommandListHandle create_command_list(std::string label) = 0;

  /// Executes the list, which can be submitted again. The CPU device has finished when this returns.
  virtual FenceHandle submit(const CommandListHandle& list) = 0;
  /// Waits until everything submitted has executed.
  virtual void wait_idle() = 0;
  /// Waits for everything submitted, then copies `bytes.size()` bytes of `buffer` from `offset` on.
  virtual void download(const BufferHandle& buffer, std::uint64_t offset, std::span<std::byte> bytes) = 0;

 protected:
  explicit Device(DeviceInfo info) : info_(std::move(info)) {}

 private:
  DeviceInfo info_;
};

using DeviceHandle = std::shared_ptr<Device>;

}  // namespace tandem::rhi
