#include <fmt/format.h>

#include <algorithm>

#include "program/amber/read/parser.hpp"

// What only ray tracing pipelines have: SHADER_GROUP, SHADER_BINDING_TABLE, libraries and limits.
namespace tandem::program::amber {
namespace {

constexpr std::array commands = {std::string_view("SHADER_GROUP"),
                                 std::string_view("SHADER_BINDING_TABLE"),
                                 std::string_view("FLAGS"),
                                 std::string_view("USE_LIBRARY"),
                                 std::string_view("MAX_RAY_PAYLOAD_SIZE"),
                                 std::string_view("MAX_RAY_HIT_ATTRIBUTE_SIZE"),
                                 std::string_view("MAX_RAY_RECURSION_DEPTH")};

const DraftGroup* find_group(const DraftPipeline& pipeline, std::string_view name) {
  const auto found =
      std::find_if(pipeline.groups.begin(), pipeline.groups.end(), [&](const auto& each) { return each.name == name; });
  return found == pipeline.groups.end() ? nullptr : &*found;
}

/// The stage of the pipeline that is the shader, which is attached first unless it is.
std::size_t stage_of(DraftPipeline& pipeline, std::size_t shader, rhi::ShaderStage stage) {
  for (std::size_t i = 0; i < pipeline.stages.size(); ++i)
    if (pipeline.stages[i].shader == shader) return i;
  pipeline.stages.push_back({.shader = shader, .stage = stage});
  return pipeline.stages.size() - 1;
}

void read_group(Parser& parser, DraftPipeline& pipeline) {
  DraftGroup group;
  const Token name = parser.name("the group's name");
  group.name = name.text;
  if (find_group(pipeline, group.name) != nullptr)
    parser.fail(name.position, fmt::format("there is a group '{}' already", group.name));
  while (!parser.at_line_end()) {
    const Token shader_name = parser.name("a shader");
    const std::size_t shader = parser.shader(shader_name.text, shader_name.position);
    const std::optional<rhi::ShaderStage> stage = parser.draft().shaders[shader].stage;
    if (!stage || *stage == rhi::ShaderStage::compute)
      parser.fail(shader_name.position, fmt::format("{} is no shader of a ray tracing pipeline", shader_name.text));
    std::optional<std::size_t>& place = *stage == rhi::ShaderStage::closest_hit    ? group.closest_hit
                                        : *stage == rhi::ShaderStage::any_hit      ? group.any_hit
                                        : *stage == rhi::ShaderStage::intersection ? group.intersection
                                                                                   : group.general;
    if (place) parser.fail(shader_name.position, fmt::format("the group {} has two shaders of a kind", group.name));
    place = stage_of(pipeline, shader, *stage);
    if (group.general && (group.closest_hit || group.any_hit || group.intersection))
      parser.fail(shader_name.position, fmt::format("the group {} has shaders of a hit group and others", group.name));
  }
  if (!group.general && !group.closest_hit && !group.any_hit && !group.intersection)
    parser.fail(name.position, fmt::format("the group {} has no shader", group.name));
  pipeline.groups.push_back(std::move(group));
}

void read_table(Parser& parser, DraftPipeline& pipeline) {
  DraftTable table;
  const Token name = parser.name("the table's name");
  table.name = name.text;
  for (const DraftTable& other : pipeline.tables)
    if (other.name == table.name)
      parser.fail(name.position, fmt::format("there is a shader binding table '{}' already", table.name));
  for (Token group = parser.next_in_block("SHADER_BINDING_TABLE"); !group.is("END");
       group = parser.next_in_block("SHADER_BINDING_TABLE")) {
    if (find_group(pipeline, group.text) == nullptr)
      parser.fail(group.position, fmt::format("there is no group '{}' in {}", group.text.substr(0, 60), pipeline.name));
    table.groups.push_back(group.text);
  }
  pipeline.tables.push_back(std::move(table));
}

/// The library's groups, as if they were the pipeline's own: a device has no smaller unit than a pipeline.
void use_library(Parser& parser, DraftPipeline& pipeline, const Token& name) {
  const DraftPipeline& library = parser.draft().pipelines[parser.pipeline(name.text, name.position)];
  if (!library.library) parser.fail(name.position, fmt::format("{} is no library: it lacks FLAGS LIBRARY", name.text));
  const auto moved = [&](const std::optional<std::size_t>& stage) {
    if (!stage) return std::optional<std::size_t>();
    const DraftStage& of_library = library.stages[*stage];
    return std::optional(stage_of(pipeline, of_library.shader, of_library.stage));
  };
  for (const DraftGroup& group : library.groups) {
    if (find_group(pipeline, group.name) != nullptr)
      parser.fail(name.position, fmt::format("there is a group '{}' already", group.name));
    pipeline.groups.push_back({.name = group.name,
                               .general = moved(group.general),
                               .closest_hit = moved(group.closest_hit),
                               .any_hit = moved(group.any_hit),
                               .intersection = moved(group.intersection)});
  }
  // What the library binds its users see, unless they bind something else there.
  for (const DraftBinding& binding : library.bindings)
    if (std::none_of(pipeline.bindings.begin(), pipeline.bindings.end(), [&](const DraftBinding& each) {
          return each.set == binding.set && each.binding == binding.binding &&
                 each.array_element == binding.array_element;
        }))
      pipeline.bindings.push_back(binding);
}

void read_flags(Parser& parser, DraftPipeline& pipeline) {
  const bool on_one_line = !parser.at_line_end();
  for (;;) {
    const Token flag = on_one_line ? parser.next() : parser.next_in_block("FLAGS");
    if (flag.ends_line()) return;
    if (!on_one_line && flag.is("END")) return parser.end_line("END");
    if (!flag.is("LIBRARY"))
      parser.fail(flag.position, fmt::format("'{}' is no flag of a pipeline: LIBRARY", flag.text.substr(0, 60)));
    pipeline.library = true;
  }
}

}  // namespace

bool is_ray_tracing_command(std::string_view word) {
  return std::find(commands.begin(), commands.end(), word) != commands.end();
}

void read_ray_tracing(Parser& parser, DraftPipeline& pipeline, const Token& command) {
  if (command.is("FLAGS")) return read_flags(parser, pipeline);
  if (command.is("SHADER_GROUP")) {
    read_group(parser, pipeline);
  } else if (command.is("SHADER_BINDING_TABLE")) {
    read_table(parser, pipeline);
  } else if (command.is("USE_LIBRARY")) {
    do {
      use_library(parser, pipeline, parser.name("a library"));
    } while (!parser.at_line_end());
  } else if (command.is("MAX_RAY_RECURSION_DEPTH")) {
    pipeline.max_recursion_depth = parser.whole_number32("a depth");
  } else {
    // Sizes that libraries have to agree on; a whole pipeline knows them.
    parser.whole_number32("a number of bytes");
  }
  parser.end_line(command.text);
}

}  // namespace tandem::program::amber
