#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "program/amber/read/draft.hpp"
#include "program/amber/read/parser.hpp"

namespace tandem::program::amber {
namespace {

constexpr std::size_t most_steps = 1 << 18;

/// What the data of a script is in the job. Bound as both, it is a buffer, and an image that is written before and read
/// back after each run of a pipeline that binds it.
struct Stored {
  std::optional<std::size_t> buffer = {};
  std::optional<std::size_t> image = {};

  Storage storage() const {
    return buffer ? Storage{Storage::Kind::buffer, *buffer} : Storage{Storage::Kind::image, *image};
  }
};

/// The kinds of records, in the order of DraftRun::tables.
enum class RecordKind : std::uint8_t { ray_generation, miss, hit, callable };
constexpr std::array<std::string_view, 4> record_names = {"ray generation", "miss", "hit", "callable"};

struct GroupPlace {
  RecordKind kind = RecordKind::hit;
  std::uint32_t index = 0;  ///< in the pipeline's list of the kind
};

class Assembler {
 public:
  explicit Assembler(Draft draft) : draft_(std::move(draft)) {}

  Script assemble() {
    script_.file = draft_.file;
    for (std::size_t i = 0; i < draft_.data.size(); ++i) add_data(draft_.data[i]);
    script_.job.samplers = draft_.samplers;
    script_.job.bottom_levels = draft_.bottom_levels;
    script_.job.top_levels = draft_.top_levels;
    for (const DraftPipeline& pipeline : draft_.pipelines) add_pipeline(pipeline);
    add_steps(draft_.steps);
    script_.virtual_files = std::move(draft_.virtual_files);
    script_.requirements = std::move(draft_.requirements);
    return std::move(script_);
  }

 private:
  [[noreturn]] void fail(Position position, const std::string& why) const {
    throw ScriptError(draft_.file.string(), position, why);
  }

  void add_data(const DraftData& data) {
    Stored stored;
    if (data.bound_as_buffer || !data.bound_as_image) {
      stored.buffer = script_.job.buffers.size();
      script_.job.buffers.push_back(
          {.name = data.name, .type = make_array(data.layout.type, 0, data.layout.stride), .initial = data.bytes});
    }
    if (data.bound_as_image) {
      stored.image = script_.job.images.size();
      script_.job.images.push_back(image_of(data));
      if (stored.buffer && data.level_count > 1)
        throw Unsupported{fmt::format("{}, which has levels, as an image and as a buffer", data.name)};
    }
    stored_.push_back(stored);
  }

  Image image_of(const DraftData& data) const {
    Image image;
    image.desc.dimension = data.dimension;
    image.desc.format = *data.texel->format;
    image.desc.size = data.size;
    image.desc.level_count = data.level_count;
    image.desc.label = data.name;
    if (data.level_count == 0 || data.level_count > rhi::full_level_count(image.desc))
      fail(data.position, fmt::format("{} cannot have {} levels", data.name, data.level_count));
    image.initial = data.bytes;
    image.initial.resize(rhi::level_offset(image.desc, data.level_count - 1) +
                         rhi::level_size_in_bytes(image.desc, data.level_count - 1));
    return image;
  }

  /// The job's shader of a stage: one for each shader, stage, entry point and set of passes.
  Stage add_stage(const DraftStage& stage) {
    const DraftShader& shader = draft_.shaders[stage.shader];
    Stage result;
    result.specialization = stage.specialization;
    for (result.shader = 0; result.shader < used_.size(); ++result.shader) {
      const DraftStage& other = used_[result.shader];
      if (other.shader == stage.shader && other.stage == stage.stage && other.entry_point == stage.entry_point &&
          other.optimizations == stage.optimizations)
        return result;
    }
    used_.push_back(stage);
    script_.job.shaders.push_back(
        {.name = shader.name, .stage = stage.stage, .spirv = {}, .entry_point = stage.entry_point});
    script_.sources.push_back(shader.source);
    script_.sources.back().optimizations = stage.optimizations;
    return result;
  }

  void add_pipeline(const DraftPipeline& draft) {
    groups_.emplace_back();
    pipelines_.push_back(script_.job.pipelines.size());
    // A library's groups are those of its users; on its own it is nothing, nor is a pipeline that is derived from.
    if (draft.library || draft.stages.empty()) return;
    Pipeline pipeline;
    pipeline.name = draft.name;
    if (draft.ray_tracing) {
      pipeline.stages = ray_tracing_stages(draft);
    } else {
      const DraftStage& stage = draft.stages.front();
      pipeline.stages = ComputeStages{.shader = add_stage(stage),
                                      .required_subgroup_size = stage.required_subgroup_size,
                                      .full_subgroups = stage.full_subgroups};
      if (stage.extreme_subgroup_size)
        script_.extreme_subgroup_sizes.push_back({script_.job.pipelines.size(), *stage.extreme_subgroup_size});
    }
    for (const DraftBinding& binding : draft.bindings) pipeline.bindings.push_back(binding_of(binding));
    if (draft.push_constants) pipeline.push_constants = draft_.data[*draft.push_constants].bytes;
    script_.job.pipelines.push_back(std::move(pipeline));
  }

  RayTracingStages ray_tracing_stages(const DraftPipeline& draft) {
    RayTracingStages stages;
    stages.max_recursion_depth = draft.max_recursion_depth;
    for (const DraftGroup& group : draft.groups) {
      GroupPlace place;
      if (!group.general) {
        const auto stage = [&](const std::optional<std::size_t>& index) {
          return index ? std::optional(add_stage(draft.stages[*index])) : std::nullopt;
        };
        place.index = static_cast<std::uint32_t>(stages.hit_groups.size());
        stages.hit_groups.push_back({.closest_hit = stage(group.closest_hit),
                                     .any_hit = stage(group.any_hit),
                                     .intersection = stage(group.intersection)});
      } else {
        const DraftStage& stage = draft.stages[*group.general];
        place.kind = stage.stage == rhi::ShaderStage::miss       ? RecordKind::miss
                     : stage.stage == rhi::ShaderStage::callable ? RecordKind::callable
                                                                 : RecordKind::ray_generation;
        std::vector<Stage>& list = place.kind == RecordKind::miss       ? stages.miss
                                   : place.kind == RecordKind::callable ? stages.callable
                                                                        : stages.ray_generation;
        place.index = static_cast<std::uint32_t>(list.size());
        list.push_back(add_stage(stage));
      }
      groups_.back().push_back(place);
    }
    if (stages.ray_generation.empty()) fail(draft.position, fmt::format("{} has no ray generation shader", draft.name));
    return stages;
  }

  Binding binding_of(const DraftBinding& draft) const {
    Binding binding = {
        .set = draft.set, .binding = draft.binding, .array_element = draft.array_element, .resource = BufferUse{}};
    switch (draft.kind) {
      case DraftBinding::Kind::buffer:
        binding.resource = BufferUse{*stored_[draft.index].buffer, draft.offset, draft.size};
        break;
      case DraftBinding::Kind::texel_buffer:
        binding.resource = TexelBufferUse{*stored_[draft.index].buffer, *draft_.data[draft.index].texel->format};
        break;
      case DraftBinding::Kind::storage_image:
        binding.resource =
            ImageUse{.image = *stored_[draft.index].image, .first_level = draft.base_level, .level_count = 1};
        break;
      case DraftBinding::Kind::sampled_image:
      case DraftBinding::Kind::combined_image_sampler:
        binding.resource =
            ImageUse{.image = *stored_[draft.index].image, .sampler = draft.sampler, .first_level = draft.base_level};
        break;
      case DraftBinding::Kind::sampler:
        binding.resource = SamplerUse{draft.index};
        break;
      case DraftBinding::Kind::acceleration_structure:
        binding.resource = TopLevelUse{draft.index};
        break;
    }
    return binding;
  }

  void add_command(Command command, Position position) {
    if (script_.steps.size() >= most_steps)
      fail(position, fmt::format("a script of more than {} steps is too long", most_steps));
    script_.steps.push_back({Step::Kind::command, script_.job.commands.size()});
    script_.job.commands.push_back(std::move(command));
  }

  void add_steps(const std::vector<DraftStep>& steps) {
    for (const DraftStep& step : steps) std::visit([&](const auto& each) { add(each); }, step);
  }

  void add(const DraftRun& run) {
    const DraftPipeline& pipeline = draft_.pipelines[run.pipeline];
    std::vector<Stored> shared;
    for (const DraftBinding& binding : pipeline.bindings)
      if (binding.kind == DraftBinding::Kind::storage_image || binding.kind == DraftBinding::Kind::sampled_image ||
          binding.kind == DraftBinding::Kind::combined_image_sampler)
        if (stored_[binding.index].buffer) shared.push_back(stored_[binding.index]);
    for (const Stored& each : shared) add_command(CopyBufferToImage{*each.buffer, *each.image}, run.position);
    if (pipeline.ray_tracing) {
      add_command(trace(pipeline, run), run.position);
    } else {
      add_command(Dispatch{.pipeline = pipelines_[run.pipeline], .workgroup_count = run.size}, run.position);
    }
    for (const Stored& each : shared) add_command(CopyImageToBuffer{*each.image, *each.buffer}, run.position);
  }

  std::vector<Record> records_of(const DraftPipeline& pipeline, const DraftRun& run, RecordKind kind) const {
    const std::optional<std::size_t>& table = run.tables[static_cast<std::size_t>(kind)];
    std::vector<Record> records;
    if (!table) return records;
    const std::vector<GroupPlace>& places = groups_[run.pipeline];
    for (const std::string& name : pipeline.tables[*table].groups) {
      const auto group = std::find_if(pipeline.groups.begin(), pipeline.groups.end(),
                                      [&](const DraftGroup& each) { return each.name == name; });
      const GroupPlace& place = places[static_cast<std::size_t>(group - pipeline.groups.begin())];
      if (place.kind != kind)
        fail(run.position, fmt::format("the group {} of the table {} is a {} group, not a {} group", name,
                                       pipeline.tables[*table].name, record_names[static_cast<std::size_t>(place.kind)],
                                       record_names[static_cast<std::size_t>(kind)]));
      records.push_back({.shader = place.index});
    }
    return records;
  }

  TraceRays trace(const DraftPipeline& pipeline, const DraftRun& run) const {
    const std::vector<Record> ray_generation = records_of(pipeline, run, RecordKind::ray_generation);
    if (ray_generation.empty()) fail(run.position, "the table of the ray generation shader has no group");
    return {.pipeline = pipelines_[run.pipeline],
            .ray_generation = ray_generation.front(),
            .miss = records_of(pipeline, run, RecordKind::miss),
            .hit = records_of(pipeline, run, RecordKind::hit),
            .callable = records_of(pipeline, run, RecordKind::callable),
            .size = run.size};
  }

  void add(const DraftCopy& copy) {
    const Storage from = stored_[copy.from].storage();
    const Storage to = stored_[copy.to].storage();
    const bool from_image = from.kind == Storage::Kind::image;
    const bool to_image = to.kind == Storage::Kind::image;
    if (from_image != to_image && (draft_.data[copy.from].level_count > 1 || draft_.data[copy.to].level_count > 1))
      fail(copy.position, "an image with levels is not copied to or from a buffer");
    if (from_image)
      add_command(to_image ? Command(CopyImage{from.index, to.index}) : CopyImageToBuffer{from.index, to.index},
                  copy.position);
    else
      add_command(to_image ? Command(CopyBufferToImage{from.index, to.index}) : CopyBuffer{from.index, to.index},
                  copy.position);
  }

  void add(const DraftExpectation& draft) {
    Expectation expectation = draft.expectation;
    expectation.storage = stored_[expectation.storage.index].storage();
    if (auto* buffers = std::get_if<BuffersExpectation>(&expectation.what))
      buffers->other = stored_[buffers->other.index].storage();
    if (script_.steps.size() >= most_steps)
      fail(expectation.position, fmt::format("a script of more than {} steps is too long", most_steps));
    script_.steps.push_back({Step::Kind::expectation, script_.expectations.size()});
    script_.expectations.push_back(std::move(expectation));
  }

  void add(const DraftRepeat& repeat) {
    if (repeat.steps.empty()) return;
    for (std::uint32_t i = 0; i < repeat.count; ++i) add_steps(repeat.steps);
  }

  Draft draft_;
  Script script_;
  std::vector<Stored> stored_;                   ///< by data
  std::vector<std::vector<GroupPlace>> groups_;  ///< by pipeline, then by group
  std::vector<std::size_t> pipelines_;           ///< of the job, by pipeline of the draft
  std::vector<DraftStage> used_;                 ///< by shader of the job
};

}  // namespace

Script assemble(Draft draft) { return Assembler(std::move(draft)).assemble(); }

}  // namespace tandem::program::amber
