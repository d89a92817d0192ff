#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <spirv-tools/libspirv.hpp>
#include <spirv-tools/optimizer.hpp>
#include <string>
#include <vector>

#include "program/amber/script.hpp"
#include "rhi/error.hpp"
#include "rhi/glsl/compile.hpp"

namespace tandem::program::amber {
namespace {

spv_target_env environment_of(const Script& script, const ShaderSource& source, rhi::ShaderStage stage) {
  if (source.target_env.empty()) {
    // Amber's own default, unless the script says that it is of no such SPIR-V.
    const bool is_later = std::ranges::any_of(script.requirements, [](const Requirement& requirement) {
      return requirement.kind == Requirement::Kind::device_extension && requirement.name == "VK_KHR_spirv_1_4";
    });
    return stage == rhi::ShaderStage::compute && !is_later ? SPV_ENV_UNIVERSAL_1_0 : SPV_ENV_UNIVERSAL_1_4;
  }
  spv_target_env environment = SPV_ENV_UNIVERSAL_1_0;
  if (!spvParseTargetEnv(source.target_env.c_str(), &environment))
    throw ScriptError(script.file.string(), source.position,
                      fmt::format("'{}' is no target environment", source.target_env.substr(0, 60)));
  return environment;
}

/// What glslang can write for the environment.
glsl::SpirvVersion version_of(spv_target_env environment) {
  switch (environment) {
    case SPV_ENV_UNIVERSAL_1_3:
    case SPV_ENV_VULKAN_1_1:
      return glsl::SpirvVersion::v1_3;
    case SPV_ENV_UNIVERSAL_1_4:
    case SPV_ENV_VULKAN_1_1_SPIRV_1_4:
      return glsl::SpirvVersion::v1_4;
    case SPV_ENV_UNIVERSAL_1_5:
    case SPV_ENV_VULKAN_1_2:
      return glsl::SpirvVersion::v1_5;
    case SPV_ENV_UNIVERSAL_1_6:
    case SPV_ENV_VULKAN_1_3:
      return glsl::SpirvVersion::v1_6;
    default:
      return glsl::SpirvVersion::v1_0;
  }
}

/// Whether the source is of OpenGL ES: "#version 310 es".
bool is_es(std::string_view source) {
  const std::size_t version = source.find("#version");
  if (version == std::string_view::npos) return false;
  const std::string_view line = source.substr(version, source.substr(version).find('\n'));
  return line.find(" es") != std::string_view::npos;
}

/// Nothing but what is printable, on one line.
std::string one_line(std::string_view text) {
  constexpr std::size_t longest = 300;
  std::string line(text.substr(0, std::min(text.find('\n'), longest)));
  for (char& c : line)
    if (c < ' ' || c > '~') c = '?';
  return line;
}

std::vector<std::uint32_t> compile_glsl(const Script& script, const ShaderSource& source, const Shader& shader,
                                        spv_target_env environment, bool debug_info) {
  glsl::CompileOptions options;
  options.debug_info = debug_info;
  options.spirv = version_of(environment);
  options.include_directories = {script.file.parent_path()};
  for (const VirtualFile& file : script.virtual_files) options.files.push_back({file.path, file.text});
  // With as many lines in front of it as in the script, glslang's messages name the script's lines. ES takes none.
  const std::uint32_t lines_before = source.path.empty() && !is_es(source.text) ? source.text_position.line - 1 : 0;
  const std::string text = std::string(lines_before, '\n') + source.text;
  try {
    return glsl::compile(text, shader.stage, source.path.empty() ? script.file.string() : source.path, options);
  } catch (const rhi::Error& error) {
    std::string_view why = error.what();
    if (why.starts_with(error.label() + ": ")) why.remove_prefix(error.label().size() + 2);
    throw ScriptError(script.file.string(), source.position, fmt::format("the shader {}: {}", shader.name, why));
  }
}

std::vector<std::uint32_t> assemble_spirv(const Script& script, const ShaderSource& source, const Shader& shader,
                                          spv_target_env environment) {
  spvtools::SpirvTools tools(environment);
  Position position = source.position;
  std::string message;
  tools.SetMessageConsumer([&](spv_message_level_t, const char*, const spv_position_t& place, const char* text) {
    if (!message.empty()) return;
    message = one_line(text);
    if (source.path.empty())
      position = {source.text_position.line + static_cast<std::uint32_t>(place.line),
                  static_cast<std::uint32_t>(place.column) + 1};
  });
  std::vector<std::uint32_t> words;
  if (!tools.Assemble(source.text, &words, SPV_TEXT_TO_BINARY_OPTION_PRESERVE_NUMERIC_IDS))
    throw ScriptError(script.file.string(), position,
                      fmt::format("the shader {} is no SPIR-V assembly: {}", shader.name, message));
  return words;
}

std::vector<std::uint32_t> optimize(const Script& script, const ShaderSource& source,
                                    const std::vector<std::uint32_t>& words, spv_target_env environment) {
  spvtools::Optimizer optimizer(environment);
  optimizer.SetMessageConsumer([](spv_message_level_t, const char*, const spv_position_t&, const char*) {});
  std::vector<std::uint32_t> optimized;
  if (!optimizer.RegisterPassesFromFlags(source.optimizations) ||
      !optimizer.Run(words.data(), words.size(), &optimized))
    throw ScriptError(script.file.string(), source.position, "SPIRV-Tools does not take the SHADER_OPTIMIZATION");
  return optimized;
}

std::vector<std::uint32_t> compile_shader(const Script& script, const ShaderSource& source, const Shader& shader,
                                          bool debug_info) {
  const spv_target_env environment = environment_of(script, source, shader.stage);
  std::vector<std::uint32_t> words;
  switch (source.language) {
    case Language::glsl:
      words = compile_glsl(script, source, shader, environment, debug_info);
      break;
    case Language::spirv_assembly:
      words = assemble_spirv(script, source, shader, environment);
      break;
    case Language::spirv:
      if (source.text.size() % sizeof(std::uint32_t) != 0)
        throw ScriptError(script.file.string(), source.position,
                          fmt::format("the {} bytes of the shader {} are no words", source.text.size(), shader.name));
      words.resize(source.text.size() / sizeof(std::uint32_t));
      std::memcpy(words.data(), source.text.data(), source.text.size());
      break;
  }
  return source.optimizations.empty() ? words : optimize(script, source, words, environment);
}

}  // namespace

void compile(Script& script, bool debug_info) {
  for (std::size_t i = 0; i < script.sources.size(); ++i)
    script.job.shaders[i].spirv = compile_shader(script, script.sources[i], script.job.shaders[i], debug_info);
}

}  // namespace tandem::program::amber
