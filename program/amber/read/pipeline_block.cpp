#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "program/amber/read/parser.hpp"

// PIPELINE and DERIVE_PIPELINE.
namespace tandem::program::amber {
namespace {

/// Commands of graphics pipelines, and those that only OpenCL C has.
bool is_of_graphics(const Token& command) {
  for (const std::string_view word :
       {"VIEWPORT", "VERTEX_DATA", "INDEX_DATA", "POLYGON_MODE", "PATCH_CONTROL_POINTS", "DEPTH", "STENCIL", "BLEND"})
    if (command.is(word)) return true;
  return false;
}

std::optional<rhi::ShaderStage> stage_of(Parser& parser, const Token& token) {
  using enum rhi::ShaderStage;
  if (token.is("compute")) return compute;
  if (token.is("ray_generation")) return ray_generation;
  if (token.is("any_hit")) return any_hit;
  if (token.is("closest_hit")) return closest_hit;
  if (token.is("miss")) return miss;
  if (token.is("intersection")) return intersection;
  if (token.is("callable")) return callable;
  parser.fail(token.position, fmt::format("'{}' is no stage of a compute or ray tracing pipeline", token.text));
}

rhi::SpecializationValue read_specialization(Parser& parser) {
  rhi::SpecializationValue result;
  result.id = parser.whole_number32("the id of a specialisation constant");
  parser.expect("AS");
  const Token type = parser.name("a type");
  const std::optional<DataType> data_type = parse_data_type(type.text);
  if (!data_type || data_type->rows != 1 || data_type->columns != 1 || data_type->is_array)
    parser.fail(type.position, fmt::format("'{}' is no type of a specialisation constant", type.text));
  const Token token = parser.lexer().peek();
  const Number number = parser.number("a value");
  if (!fits(number, data_type->scalar))
    parser.fail(token.position, fmt::format("{} is no {}", token.text, name_of(data_type->scalar)));
  std::array<std::byte, sizeof(result.value)> bytes = {};
  write(bytes, data_type->scalar, number);
  result.value = std::bit_cast<std::uint64_t>(bytes);
  return result;
}

void read_attach(Parser& parser, DraftPipeline& pipeline) {
  const Token name = parser.name("a shader");
  DraftStage stage;
  stage.shader = parser.shader(name.text, name.position);
  const DraftShader& shader = parser.draft().shaders[stage.shader];
  std::optional<rhi::ShaderStage> kind = shader.stage;
  for (Token option = parser.next(); !option.ends_line(); option = parser.next()) {
    if (option.is("TYPE")) {
      kind = stage_of(parser, parser.name("a shader stage"));
    } else if (option.is("ENTRY_POINT")) {
      stage.entry_point = parser.name("an entry point").text;
    } else if (option.is("SPECIALIZE")) {
      stage.specialization.push_back(read_specialization(parser));
    } else {
      parser.fail(option.position, fmt::format("'{}' is no option of ATTACH: TYPE, ENTRY_POINT or SPECIALIZE",
                                               option.text.substr(0, 60)));
    }
  }
  if (!kind)
    parser.fail(name.position, fmt::format("{} is no shader of a compute or ray tracing pipeline{}", shader.name,
                                           shader.multi ? " without a TYPE" : ""));
  stage.stage = *kind;
  if (pipeline.ray_tracing == (stage.stage == rhi::ShaderStage::compute))
    parser.fail(name.position, fmt::format("{} is no shader of a {} pipeline", shader.name,
                                           pipeline.ray_tracing ? "ray tracing" : "compute"));
  if (!pipeline.ray_tracing && !pipeline.stages.empty())
    parser.fail(name.position, fmt::format("the compute pipeline {} has a shader already", pipeline.name));
  pipeline.stages.push_back(std::move(stage));
}

/// The stage of the pipeline that has the shader named next.
DraftStage& attached(Parser& parser, DraftPipeline& pipeline) {
  const Token name = parser.name("a shader");
  const std::size_t shader = parser.shader(name.text, name.position);
  for (DraftStage& stage : pipeline.stages)
    if (stage.shader == shader) return stage;
  parser.fail(name.position, fmt::format("the shader {} is not attached to {}", name.text, pipeline.name));
}

void read_optimizations(Parser& parser, DraftPipeline& pipeline) {
  DraftStage& stage = attached(parser, pipeline);
  for (Token pass = parser.next_in_block("SHADER_OPTIMIZATION"); !pass.is("END");
       pass = parser.next_in_block("SHADER_OPTIMIZATION"))
    stage.optimizations.push_back(pass.text);
  parser.end_line("END");
}

void read_subgroup(Parser& parser, DraftPipeline& pipeline) {
  DraftStage& stage = attached(parser, pipeline);
  for (Token option = parser.next_in_block("SUBGROUP"); !option.is("END"); option = parser.next_in_block("SUBGROUP")) {
    if (option.is("FULLY_POPULATED")) {
      stage.full_subgroups = parser.on_or_off("FULLY_POPULATED");
    } else if (option.is("VARYING_SIZE")) {
      // Every size may be chosen then, so also the one that a device takes without it.
      parser.on_or_off("VARYING_SIZE");
    } else if (option.is("REQUIRED_SIZE")) {
      if (parser.next_is("MIN") || parser.next_is("MAX")) {
        stage.extreme_subgroup_size = parser.next().is("MAX");
      } else {
        const Position position = parser.lexer().position();
        stage.required_subgroup_size = parser.whole_number32("a subgroup size, MIN or MAX");
        if (!std::has_single_bit(stage.required_subgroup_size))
          parser.fail(position, "a subgroup size is a power of two");
      }
    } else {
      parser.fail(option.position, fmt::format("'{}' is no option of SUBGROUP", option.text.substr(0, 60)));
    }
  }
  parser.end_line("END");
}

/// Images without a size of their own get that of the framebuffer of a pipeline that binds them.
void set_framebuffer_size(Parser& parser, const DraftPipeline& pipeline, const std::array<std::uint32_t, 2>& size) {
  for (const DraftBinding& binding : pipeline.bindings) {
    if (binding.kind == DraftBinding::Kind::sampler || binding.kind == DraftBinding::Kind::acceleration_structure)
      continue;
    DraftData& data = parser.draft().data[binding.index];
    if (!data.of_framebuffer_size) continue;
    data.size = {size[0], size[1], 1};
    data.bytes.assign(std::uint64_t{size[0]} * size[1] * data.layout.stride, std::byte{0});
  }
}

std::array<std::uint32_t, 2> read_framebuffer_size(Parser& parser) {
  constexpr std::uint32_t largest = 1 << 13;
  std::array<std::uint32_t, 2> size = {};
  for (std::uint32_t& side : size) {
    const Position position = parser.lexer().position();
    side = parser.whole_number32("a number of pixels");
    if (side == 0 || side > largest) parser.fail(position, "a framebuffer has 1 to 8192 pixels a side");
  }
  parser.end_line("FRAMEBUFFER_SIZE");
  return size;
}

void read_body(Parser& parser, DraftPipeline& pipeline) {
  std::optional<std::array<std::uint32_t, 2>> framebuffer_size;
  for (Token command = parser.next_in_block("PIPELINE"); !command.is("END");
       command = parser.next_in_block("PIPELINE")) {
    if (command.is("ATTACH")) {
      read_attach(parser, pipeline);
    } else if (command.is("BIND")) {
      read_binding(parser, pipeline);
    } else if (command.is("FRAMEBUFFER_SIZE")) {
      framebuffer_size = read_framebuffer_size(parser);
    } else if (command.is("SUBGROUP")) {
      read_subgroup(parser, pipeline);
    } else if (command.is("SHADER_OPTIMIZATION")) {
      read_optimizations(parser, pipeline);
    } else if (command.is("SET") || command.is("COMPILE_OPTIONS")) {
      parser.unsupported(command.position, fmt::format("{}, which is of OpenCL C", command.text));
    } else if (is_ray_tracing_command(command.text)) {
      if (!pipeline.ray_tracing)
        parser.fail(command.position, fmt::format("{} is of ray tracing pipelines", command.text));
      read_ray_tracing(parser, pipeline, command);
    } else if (is_of_graphics(command)) {
      parser.fail(command.position, fmt::format("{} is of graphics pipelines", command.text));
    } else {
      parser.fail(command.position, fmt::format("'{}' is no command of a pipeline", command.text.substr(0, 60)));
    }
  }
  parser.end_line("END");
  if (framebuffer_size) set_framebuffer_size(parser, pipeline, *framebuffer_size);
  parser.draft().pipelines.push_back(std::move(pipeline));
}

}  // namespace

void read_pipeline(Parser& parser) {
  const Token kind = parser.name("compute, raytracing or graphics");
  DraftPipeline pipeline;
  pipeline.position = parser.lexer().position();
  if (kind.is("graphics")) parser.unsupported(kind.position, "a graphics pipeline");
  pipeline.ray_tracing = kind.is("raytracing") || kind.is("ray_tracing");
  if (!pipeline.ray_tracing && !kind.is("compute"))
    parser.fail(kind.position,
                fmt::format("a pipeline is compute, raytracing or graphics, not '{}'", kind.text.substr(0, 60)));
  pipeline.name = parser.new_name("pipeline");
  parser.end_line("PIPELINE");
  read_body(parser, pipeline);
}

void read_derived_pipeline(Parser& parser) {
  const Position position = parser.lexer().position();
  std::string name = parser.new_name("pipeline");
  parser.expect("FROM");
  const Token parent = parser.name("a pipeline");
  DraftPipeline pipeline = parser.draft().pipelines[parser.pipeline(parent.text, parent.position)];
  pipeline.name = std::move(name);
  pipeline.position = position;
  parser.end_line("DERIVE_PIPELINE");
  read_body(parser, pipeline);
}

}  // namespace tandem::program::amber
