#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "program/job/geometry.hpp"
#include "program/job/value_type.hpp"
#include "rhi/buffer.hpp"
#include "rhi/pipeline.hpp"
#include "rhi/sampler.hpp"
#include "rhi/shader_reflection.hpp"
#include "rhi/texture.hpp"

/// A job: shaders, what they are bound to, and the commands that run them, as values that name no device. `tandem run`
/// makes one from options, `tandem amber` from a script; Execution runs it on a device. Things are named by their
/// position in the job's vectors.
namespace tandem::program {

struct Shader {
  std::string name;  ///< in messages
  rhi::ShaderStage stage = rhi::ShaderStage::compute;
  std::vector<std::uint32_t> spirv;
  std::string entry_point = {};  ///< of a module that has several; "": the only one
};

/// Memory that pipelines share.
struct Buffer {
  std::string name;
  ValueType type = make_array(make_type(ScalarType::uint32), 0);  ///< how its bytes are printed and compared
  std::vector<std::byte> initial = {};                            ///< all of its bytes; at least one
};

struct Image {
  rhi::TextureDesc desc;                ///< the label is its name in messages
  std::vector<std::byte> initial = {};  ///< all levels, as Texture::size_in_bytes says; empty: zeros
};

struct BufferUse {
  std::size_t buffer = 0;
  std::uint64_t offset = 0;
  std::uint64_t size = rhi::whole_size;
};
struct TexelBufferUse {
  std::size_t buffer = 0;
  rhi::TextureFormat format = rhi::TextureFormat::r32_float;
};
/// An image, for a combined image sampler with the sampler.
struct ImageUse {
  std::size_t image = 0;
  std::optional<std::size_t> sampler = {};
  std::uint32_t first_level = 0;
  std::uint32_t level_count = 0;                        ///< 0: all; of a storage image one
  std::optional<rhi::TextureDimension> dimension = {};  ///< what the shader sees, where it is another
};
struct SamplerUse {
  std::size_t sampler = 0;
};
struct TopLevelUse {
  std::size_t top_level = 0;
};

/// One descriptor. Those that no shader of the pipeline uses are left out by Execution.
struct Binding {
  std::uint32_t set = 0;
  std::uint32_t binding = 0;
  std::uint32_t array_element = 0;
  std::variant<BufferUse, TexelBufferUse, ImageUse, SamplerUse, TopLevelUse> resource;
};

/// A shader of a pipeline, with its constants.
struct Stage {
  std::size_t shader = 0;
  std::vector<rhi::SpecializationValue> specialization = {};
};

struct HitGroup {
  std::optional<Stage> closest_hit = {};
  std::optional<Stage> any_hit = {};
  std::optional<Stage> intersection = {};
};

struct ComputeStages {
  Stage shader;
  std::uint32_t required_subgroup_size = 0;  ///< rhi::ComputePipelineDesc
  bool full_subgroups = false;
};

/// The records of a shader binding table name these by position.
struct RayTracingStages {
  std::vector<Stage> ray_generation;
  std::vector<Stage> miss = {};
  std::vector<HitGroup> hit_groups = {};
  std::vector<Stage> callable = {};
  std::uint32_t max_recursion_depth = 1;
};

struct Pipeline {
  std::string name;
  std::variant<ComputeStages, RayTracingStages> stages;
  std::vector<Binding> bindings = {};
  /// Cut, or padded with zeros, to what the shaders declare.
  std::vector<std::byte> push_constants = {};
};

struct Record {
  std::uint32_t shader = 0;          ///< position in the pipeline's list of this kind, or rhi::no_shader
  std::vector<std::byte> data = {};  ///< the shaderRecordEXT block
};

/// Runs workgroups of a compute pipeline.
struct Dispatch {
  std::size_t pipeline = 0;
  std::array<std::uint32_t, 3> workgroup_count = {1, 1, 1};
  std::array<std::uint32_t, 3> base_workgroup = {0, 0, 0};
};

/// Runs a ray generation shader.
struct TraceRays {
  std::size_t pipeline = 0;
  Record ray_generation = {};
  std::vector<Record> miss = {};
  std::vector<Record> hit = {};
  std::vector<Record> callable = {};
  std::array<std::uint32_t, 3> size = {1, 1, 1};
};

/// Copies all bytes of a buffer into another, which is at least as large.
struct CopyBuffer {
  std::size_t source = 0;
  std::size_t destination = 0;
};
/// Copies all levels of an image into another of the same size and format.
struct CopyImage {
  std::size_t source = 0;
  std::size_t destination = 0;
};
/// All levels of an image, tightly packed as rhi::Texture says, to or from a buffer, which is at least as large.
struct CopyImageToBuffer {
  std::size_t source = 0;
  std::size_t destination = 0;
};
struct CopyBufferToImage {
  std::size_t source = 0;
  std::size_t destination = 0;
};

using Command = std::variant<Dispatch, TraceRays, CopyBuffer, CopyImage, CopyImageToBuffer, CopyBufferToImage>;

struct Job {
  std::vector<Shader> shaders = {};
  std::vector<Buffer> buffers = {};
  std::vector<Image> images = {};
  std::vector<rhi::SamplerDesc> samplers = {};
  std::vector<BottomLevel> bottom_levels = {};
  std::vector<TopLevel> top_levels = {};
  std::vector<Pipeline> pipelines = {};
  std::vector<Command> commands = {};  ///< in their order
};

}  // namespace tandem::program
