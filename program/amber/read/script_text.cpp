#include "program/amber/script.hpp"

#include <fmt/format.h>

#include "base/text_file.hpp"
#include "program/amber/read/parser.hpp"

namespace tandem::program::amber {
namespace {

void read_requirement(Parser& parser, Requirement::Kind kind) {
  const Token name = parser.name("a name");
  const bool is_extension =
      kind == Requirement::Kind::device_extension || kind == Requirement::Kind::instance_extension;
  if (!is_extension && !is_known(kind, name.text))
    parser.fail(name.position, fmt::format("'{}' is no {} that Amber knows", name.text.substr(0, 80),
                                           kind == Requirement::Kind::feature ? "device feature" : "device property"));
  parser.draft().requirements.push_back({kind, name.text, name.position});
  parser.end_line("the name");
}

void read_setting(Parser& parser) {
  parser.expect("ENGINE_DATA");
  const Token name = parser.name("a setting");
  if (!name.is("fence_timeout_ms"))
    parser.fail(name.position, fmt::format("'{}' is no setting: fence_timeout_ms", name.text.substr(0, 60)));
  // How long a device may take is a matter of the machine, not of the script.
  parser.whole_number32("milliseconds");
  parser.end_line("SET");
}

/// One command of the script.
void read_command(Parser& parser, const Token& command) {
  if (command.is("DEVICE_FEATURE")) return read_requirement(parser, Requirement::Kind::feature);
  if (command.is("DEVICE_PROPERTY")) return read_requirement(parser, Requirement::Kind::property);
  if (command.is("DEVICE_EXTENSION")) return read_requirement(parser, Requirement::Kind::device_extension);
  if (command.is("INSTANCE_EXTENSION")) return read_requirement(parser, Requirement::Kind::instance_extension);
  if (command.is("SHADER")) return read_shader(parser);
  if (command.is("VIRTUAL_FILE")) return read_virtual_file(parser);
  if (command.is("STRUCT")) return read_struct(parser);
  if (command.is("BUFFER")) return read_buffer(parser);
  if (command.is("IMAGE")) return read_image(parser);
  if (command.is("SAMPLER")) return read_sampler(parser);
  if (command.is("ACCELERATION_STRUCTURE")) return read_acceleration_structure(parser);
  if (command.is("PIPELINE")) return read_pipeline(parser);
  if (command.is("DERIVE_PIPELINE")) return read_derived_pipeline(parser);
  if (command.is("REPEAT")) return read_repeat(parser, parser.draft().steps);
  if (command.is("SET")) return read_setting(parser);
  if (command.is("CLEAR") || command.is("CLEAR_COLOR") || command.is("CLEAR_DEPTH") || command.is("CLEAR_STENCIL"))
    parser.fail(command.position, fmt::format("{} is of graphics pipelines", command.text));
  if (!read_step(parser, command, parser.draft().steps))
    parser.fail(command.position, fmt::format("'{}' is no command", command.text.substr(0, 60)));
}

/// VkScript, the older language of files of this name, has sections in brackets.
bool is_vkscript(std::string_view text) {
  Lexer lexer(text);
  Token token = lexer.next();
  while (token.kind == Token::Kind::end_of_line) token = lexer.next();
  return token.text.starts_with('[');
}

}  // namespace

Script parse(std::string_view text, const std::filesystem::path& file) {
  if (is_vkscript(text)) return parse_vkscript(text, file);
  Parser parser(text, file);
  if (!text.starts_with("#!amber")) parser.fail({}, "the first line is not #!amber");
  try {
    for (Token command = parser.next(); command.kind != Token::Kind::end; command = parser.next())
      if (command.kind != Token::Kind::end_of_line) read_command(parser, command);
    return assemble(std::move(parser.draft()));
  } catch (const Unsupported& reason) {
    Script script;
    script.file = file;
    script.requirements = parser.draft().requirements;
    script.unsupported = reason.why;
    return script;
  }
}

Script read(const std::filesystem::path& file) { return parse(read_text(file), file); }

}  // namespace tandem::program::amber
