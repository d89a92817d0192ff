#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cstring>

#include "base/input_file.hpp"
#include "program/amber/read/parser.hpp"

// SHADER and VIRTUAL_FILE.
namespace tandem::program::amber {
namespace {

constexpr std::uint64_t largest_shader_file = 64 << 20;

struct StageName {
  std::string_view name;
  rhi::ShaderStage stage;
};
constexpr std::array<StageName, 7> stage_names = {{{"compute", rhi::ShaderStage::compute},
                                                   {"ray_generation", rhi::ShaderStage::ray_generation},
                                                   {"any_hit", rhi::ShaderStage::any_hit},
                                                   {"closest_hit", rhi::ShaderStage::closest_hit},
                                                   {"miss", rhi::ShaderStage::miss},
                                                   {"intersection", rhi::ShaderStage::intersection},
                                                   {"callable", rhi::ShaderStage::callable}}};
constexpr std::array graphics_stages = {std::string_view("vertex"), std::string_view("fragment"),
                                        std::string_view("geometry"), std::string_view("tessellation_evaluation"),
                                        std::string_view("tessellation_control")};

/// The words of SPIRV-HEX as bytes of this machine: numbers of 32 bits, or of 8 in the order of a file.
std::string hexadecimal_words(Parser& parser, const std::string& text, Position position) {
  std::string bytes;
  Lexer lexer(text);
  for (Token token = lexer.next(); token.kind != Token::Kind::end; token = lexer.next()) {
    if (token.kind == Token::Kind::end_of_line || token.text == ",") continue;
    std::string_view digits = token.text;
    if (digits.starts_with("0x")) digits.remove_prefix(2);
    std::uint32_t value = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value, 16);
    if (error != std::errc() || end != digits.data() + digits.size()) {
      const Position place = {position.line + token.position.line - 1, token.position.column};
      parser.fail(place, fmt::format("'{}' is no hexadecimal word of SPIR-V", token.text.substr(0, 60)));
    }
    if (digits.size() <= 2) {
      bytes += static_cast<char>(value);
    } else {
      bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));
    }
  }
  return bytes;
}

void set_stage(Parser& parser, DraftShader& shader, const Token& word) {
  if (word.is("multi")) {
    shader.multi = true;
    return;
  }
  for (const StageName& each : stage_names)
    if (word.is(each.name)) shader.stage = each.stage;
  if (shader.stage) return;
  for (const std::string_view graphics : graphics_stages)
    if (word.is(graphics)) return;
  parser.fail(word.position, fmt::format("'{}' is no shader stage", word.text));
}

/// True when the words are hexadecimal text.
bool set_language(Parser& parser, ShaderSource& source, const Token& word) {
  if (word.is("OPENCL-C")) parser.unsupported(word.position, "a shader in OpenCL C");
  if (word.is("HLSL")) parser.unsupported(word.position, "a shader in HLSL");
  if (word.is("GLSL")) {
    source.language = Language::glsl;
  } else if (word.is("SPIRV-ASM")) {
    source.language = Language::spirv_assembly;
  } else if (word.is("SPIRV-HEX") || word.is("SPIRV-BIN")) {
    source.language = Language::spirv;
    return word.is("SPIRV-HEX");
  } else {
    parser.fail(word.position,
                fmt::format("'{}' is no shader format: GLSL, SPIRV-ASM, SPIRV-HEX or SPIRV-BIN", word.text));
  }
  return false;
}

}  // namespace

void read_shader(Parser& parser) {
  DraftShader shader;
  const Token stage = parser.name("a shader stage");
  set_stage(parser, shader, stage);
  shader.source.position = stage.position;
  shader.name = parser.new_name("shader");
  const Token format = parser.name("a shader format");
  if (format.is("PASSTHROUGH")) {
    if (!stage.is("vertex")) parser.fail(format.position, "only a vertex shader can be PASSTHROUGH");
    parser.end_line("PASSTHROUGH");
    parser.draft().shaders.push_back(std::move(shader));
    return;
  }
  const bool hexadecimal = set_language(parser, shader.source, format);
  if (parser.take("TARGET_ENV")) shader.source.target_env = parser.name("a target environment").text;
  const Token from = parser.next();
  std::string text;
  // Where the line after SHADER begins, for a text that follows.
  const Position text_position = {from.position.line + 1, 1};
  shader.source.text_position = text_position;
  if (from.is("VIRTUAL_FILE")) {
    const Token path = parser.name("a virtual file");
    const VirtualFile* found = nullptr;
    for (const VirtualFile& file : parser.draft().virtual_files)
      if (file.path == path.text) found = &file;
    if (found == nullptr) parser.fail(path.position, fmt::format("there is no virtual file '{}'", path.text));
    text = found->text;
    shader.source.path = path.text;
    parser.end_line("SHADER");
  } else if (from.is("FILE")) {
    const Token path = parser.name("a file");
    try {
      text = read_bytes(parser.beside(path.text), largest_shader_file);
    } catch (const Error& error) {
      parser.fail(path.position, error.what());
    }
    shader.source.path = parser.beside(path.text).string();
    parser.end_line("SHADER");
  } else if (from.ends_line()) {
    text = parser.block("SHADER", shader.source.position);
    if (text.find_first_not_of(" \t\r\n") == std::string::npos)
      parser.fail(shader.source.position, fmt::format("the shader {} is empty", shader.name));
    parser.end_line("END");
  } else {
    parser.fail(from.position, fmt::format("'{}' is too much after the shader's format", from.text));
  }
  shader.source.text = hexadecimal ? hexadecimal_words(parser, text, text_position) : text;
  parser.draft().shaders.push_back(std::move(shader));
}

void read_virtual_file(Parser& parser) {
  const Token path = parser.name("the virtual file's path");
  for (const VirtualFile& file : parser.draft().virtual_files)
    if (file.path == path.text)
      parser.fail(path.position, fmt::format("there is a virtual file '{}' already", path.text));
  parser.end_line("VIRTUAL_FILE");
  std::string text = parser.block("VIRTUAL_FILE", path.position);
  parser.end_line("END");
  parser.draft().virtual_files.push_back({path.text, std::move(text)});
}

}  // namespace tandem::program::amber
