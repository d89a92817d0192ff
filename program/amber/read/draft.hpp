#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "program/amber/position.hpp"
#include "program/amber/script.hpp"
#include "program/amber/value/data_type.hpp"

/// What a script has declared by the names that it uses. Which buffers are images is known only at its end.
namespace tandem::program::amber {

/// A SHADER. The stages of graphics pipelines have none of ours.
struct DraftShader {
  std::string name;
  std::optional<rhi::ShaderStage> stage = {};
  bool multi = false;  ///< the stage is that of its ATTACH
  ShaderSource source;
};

/// A BUFFER or IMAGE.
struct DraftData {
  std::string name;
  DataType type;
  LaidOut layout;
  std::optional<Texel> texel = {};  ///< empty where the type is none of an image
  bool is_image = false;            ///< declared as one: it has dimensions
  rhi::TextureDimension dimension = rhi::TextureDimension::d2;
  std::array<std::uint32_t, 3> size = {1, 1, 1};
  std::uint32_t level_count = 1;
  std::uint32_t samples = 1;
  std::vector<std::byte> bytes;      ///< of the first level
  bool of_framebuffer_size = false;  ///< the size is that of the pipeline's framebuffer
  bool bound_as_image = false;
  bool bound_as_buffer = false;
  Position position;
};

/// A BIND of one resource.
struct DraftBinding {
  enum class Kind : std::uint8_t {
    buffer,
    texel_buffer,
    storage_image,
    sampled_image,
    combined_image_sampler,
    sampler,
    acceleration_structure
  };

  Kind kind = Kind::buffer;
  std::uint32_t set = 0;
  std::uint32_t binding = 0;
  std::uint32_t array_element = 0;
  std::size_t index = 0;  ///< of the data, the sampler or the top level
  std::optional<std::size_t> sampler = {};
  std::uint64_t offset = 0;
  std::uint64_t size = rhi::whole_size;
  std::uint32_t base_level = 0;
};

/// A shader of a pipeline.
struct DraftStage {
  std::size_t shader = 0;
  rhi::ShaderStage stage = rhi::ShaderStage::compute;
  std::string entry_point = "main";
  std::vector<rhi::SpecializationValue> specialization = {};
  std::vector<std::string> optimizations = {};
  std::uint32_t required_subgroup_size = 0;
  std::optional<bool> extreme_subgroup_size = {};  ///< true: the largest
  bool full_subgroups = false;
};

/// A SHADER_GROUP: one general shader, or those of a hit group; positions in DraftPipeline::stages.
struct DraftGroup {
  std::string name;
  std::optional<std::size_t> general = {};
  std::optional<std::size_t> closest_hit = {};
  std::optional<std::size_t> any_hit = {};
  std::optional<std::size_t> intersection = {};
};

struct DraftTable {
  std::string name;
  std::vector<std::string> groups;
};

struct DraftPipeline {
  std::string name;
  bool ray_tracing = false;
  bool library = false;
  std::vector<DraftStage> stages = {};
  std::vector<DraftBinding> bindings = {};
  std::optional<std::size_t> push_constants = {};  ///< data
  std::vector<DraftGroup> groups = {};             ///< with those of its libraries
  std::vector<DraftTable> tables = {};
  std::uint32_t max_recursion_depth = 1;
  Position position;
};

struct DraftRun {
  std::size_t pipeline = 0;
  std::array<std::uint32_t, 3> size = {1, 1, 1};
  /// Of a ray tracing pipeline, positions in DraftPipeline::tables: ray generation, miss, hit, callable.
  std::array<std::optional<std::size_t>, 4> tables = {};
  Position position;
};

struct DraftCopy {
  std::size_t from = 0;
  std::size_t to = 0;
  Position position;
};

/// An expectation whose storages are positions in Draft::data.
struct DraftExpectation {
  Expectation expectation;
};

struct DraftRepeat;

using DraftStep = std::variant<DraftRun, DraftCopy, DraftExpectation, DraftRepeat>;

struct DraftRepeat {
  std::uint32_t count = 1;
  std::vector<DraftStep> steps = {};
  Position position;
};

struct Draft {
  std::filesystem::path file;
  std::vector<VirtualFile> virtual_files;
  std::vector<Requirement> requirements;
  std::map<std::string, std::shared_ptr<Struct>> structs;
  std::vector<DraftShader> shaders;
  std::vector<DraftData> data;
  std::vector<rhi::SamplerDesc> samplers;
  std::vector<BottomLevel> bottom_levels;
  std::vector<TopLevel> top_levels;
  std::vector<DraftPipeline> pipelines;
  std::vector<DraftStep> steps;
};

/// The job and the steps. Throws ScriptError.
Script assemble(Draft draft);

}  // namespace tandem::program::amber
