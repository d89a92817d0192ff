#include "tools/program/job_builder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "base/error.hpp"
#include "base/printable.hpp"
#include "program/data/fill.hpp"
#include "program/data/texels.hpp"
#include "tools/program/contents.hpp"
#include "tools/program/needs.hpp"
#include "tools/program/pipeline_builder.hpp"
#include "tools/program/resource_words.hpp"
#include "tools/program/scene_levels.hpp"

namespace tandem::tools::program_run {
namespace {

using rhi::BindingKind;

bool is_texels(BindingKind kind) {
  return kind == BindingKind::uniform_texel_buffer || kind == BindingKind::storage_texel_buffer;
}

rhi::TextureFormat texel_format(const rhi::ShaderBinding& binding, const BufferWords& words) {
  if (words.format) return *words.format;
  if (binding.format) return *binding.format;
  return binding.component == rhi::ComponentKind::uint   ? rhi::TextureFormat::r32_uint
         : binding.component == rhi::ComponentKind::sint ? rhi::TextureFormat::r32_sint
                                                         : rhi::TextureFormat::r32_float;
}

class JobBuilder {
 public:
  JobBuilder(const LoadedProgram& program, const RunOptions& options) : program_(program), options_(options) {
    result_.job.shaders = program.shaders;
  }

  BuiltJob build() {
    for (std::size_t i = 0; i < program_.launches.size(); ++i) {
      const LoadedLaunch& loaded = program_.launches[i];
      const Launch& launch = options_.launches[i];
      LaunchPipeline made = make_pipeline(program_, loaded, launch, i);
      box_record_ = made.box_record;
      for (const NeededBinding& needed : loaded.bindings) bind(made, launch, needed);
      set_pipeline(made.command, result_.job.pipelines.size());
      result_.job.pipelines.push_back(std::move(made.pipeline));
      result_.job.commands.push_back(std::move(made.command));
    }
    refuse_unused(options_.buffers);
    refuse_unused(options_.images);
    refuse_unused(options_.samplers);
    refuse_unused(options_.scenes);
    return std::move(result_);
  }

 private:
  void bind(LaunchPipeline& made, const Launch& launch, const NeededBinding& needed) {
    switch (needed.binding.kind) {
      case BindingKind::acceleration_structure:
        bind_scene(made, launch, needed);
        break;
      case BindingKind::sampler:
        add(made, needed, {}, program::SamplerUse{sampler_of(launch, needed)});
        break;
      case BindingKind::storage_image:
      case BindingKind::sampled_image:
      case BindingKind::combined_image_sampler:
        bind_each(made, launch, needed, options_.images, [&](const Setting& setting) {
          const Resource& image = image_of(setting, needed);
          program::ImageUse use{.image = image.index};
          if (needed.binding.kind == BindingKind::storage_image) use.level_count = 1;
          if (needed.binding.kind == BindingKind::combined_image_sampler) use.sampler = sampler_of(launch, needed);
          return use;
        });
        break;
      default:
        bind_each(made, launch, needed, options_.buffers,
                  [&](const Setting& setting) { return buffer_use(setting, needed); });
    }
  }

  template <typename Use>
  void bind_each(LaunchPipeline& made, const Launch& launch, const NeededBinding& needed,
                 const std::vector<Setting>& resources, const Use& use_of) {
    for (const Setting& setting : resources)
      if (const std::optional<KeyMatch> found = binds(launch, setting, needed)) {
        used_.insert(&setting);
        add(made, needed, found->element, use_of(setting));
      }
  }

  void add(LaunchPipeline& made, const NeededBinding& needed, std::optional<std::uint32_t> element,
           const decltype(program::Binding::resource)& resource) const {
    const std::uint32_t first = element.value_or(0);
    const std::uint32_t count = element ? 1 : std::max(needed.binding.count, 1u);
    for (std::uint32_t i = first; i < first + count; ++i)
      made.pipeline.bindings.push_back(
          {.set = needed.binding.set, .binding = needed.binding.binding, .array_element = i, .resource = resource});
  }

  void bind_scene(LaunchPipeline& made, const Launch& launch, const NeededBinding& needed) {
    for (const Setting& scene : options_.scenes) {
      if (!scene.key.empty() && !binds(launch, scene, needed)) continue;
      used_.insert(&scene);
      const auto known = scenes_.find(&scene);
      const std::size_t level =
          known != scenes_.end() ? known->second
                                 : add_scene(result_.job, scene, options_.is_opaque && !made.has_any_hit, box_record_);
      scenes_[&scene] = level;
      add(made, needed, {}, program::TopLevelUse{level});
      return;
    }
  }

  Resource& resource(const Setting& setting, const NeededBinding& needed, bool is_image) {
    const auto known = std::ranges::find_if(
        result_.resources, [&](const Resource& each) { return each.key == setting.key && each.is_image == is_image; });
    if (known != result_.resources.end()) return *known;
    const std::string& instance = needed.block != nullptr ? needed.block->instance : std::string();
    result_.resources.push_back({.key = setting.key,
                                 .is_image = is_image,
                                 .index = is_image ? result_.job.images.size() : result_.job.buffers.size(),
                                 .prefix = is_image || needed.block == nullptr ? setting.key
                                           : instance.empty()                  ? ""
                                                                               : instance + ".",
                                 .names = needed.names});
    return result_.resources.back();
  }

  decltype(program::Binding::resource) buffer_use(const Setting& setting, const NeededBinding& needed) {
    const BufferWords words = buffer_words(setting);
    const std::size_t before = result_.job.buffers.size();
    Resource& found = resource(setting, needed, false);
    found.is_written = found.is_written || needed.binding.writable;
    const rhi::TextureFormat format = texel_format(needed.binding, words);
    if (found.index == before) {
      program::Buffer buffer{.name = setting.key};
      if (words.type) {
        buffer.type = program::make_array(*words.type, 0);
        found.prefix = setting.key;
      } else if (needed.block != nullptr) {
        buffer.type = needed.block->type;
      } else {
        buffer.type = program::make_array(program::texel_type(format), 0);
      }
      buffer.initial = buffer_contents(setting, words, buffer.type);
      const std::uint64_t declared = needed.block != nullptr ? program::size_with(needed.block->type, 0) : 1;
      if (buffer.initial.size() < declared) buffer.initial.resize(static_cast<std::size_t>(declared));
      result_.job.buffers.push_back(std::move(buffer));
    }
    if (is_texels(needed.binding.kind)) return program::TexelBufferUse{.buffer = found.index, .format = format};
    return program::BufferUse{.buffer = found.index};
  }

  const Resource& image_of(const Setting& setting, const NeededBinding& needed) {
    const std::size_t before = result_.job.images.size();
    Resource& found = resource(setting, needed, true);
    found.is_written = found.is_written || needed.binding.writable;
    if (found.index == before) {
      result_.job.images.push_back(image_contents(setting, image_words(setting), needed.binding));
      result_.job.images.back().desc.label = setting.key;
    }
    return found;
  }

  /// That of the option for the binding; without one, the nearest texel, repeated.
  std::size_t sampler_of(const Launch& launch, const NeededBinding& needed) {
    rhi::SamplerDesc sampler{.label = needed.key()};
    if (needed.binding.compares) sampler.compare = rhi::CompareOp::less_or_equal;
    for (const Setting& setting : options_.samplers)
      if (setting.key.empty() || binds(launch, setting, needed)) {
        used_.insert(&setting);
        sampler = sampler_words(setting);
        if (needed.binding.compares && !sampler.compare) sampler.compare = rhi::CompareOp::less_or_equal;
      }
    result_.job.samplers.push_back(sampler);
    return result_.job.samplers.size() - 1;
  }

  void refuse_unused(const std::vector<Setting>& settings) const {
    for (const Setting& setting : settings) {
      if (used_.contains(&setting)) continue;
      std::string bindings;
      for (const LoadedLaunch& launch : program_.launches)
        for (const NeededBinding& needed : launch.bindings) bindings += (bindings.empty() ? "" : ", ") + needed.text();
      if (setting.key.empty()) refuse(setting, "no shader uses it");
      refuse(setting, fmt::format("'{}' is no binding of its kind; the shaders have {}", shortened(setting.key),
                                  bindings.empty() ? "none" : bindings));
    }
  }

  const LoadedProgram& program_;
  const RunOptions& options_;
  BuiltJob result_;
  std::uint32_t box_record_ = 0;
  std::set<const Setting*> used_;
  std::map<const Setting*, std::size_t> scenes_;  ///< and their top levels
};

}  // namespace

BuiltJob build_job(const LoadedProgram& program, const RunOptions& options) {
  return JobBuilder(program, options).build();
}

}  // namespace tandem::tools::program_run
