#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "program/amber/read/draft.hpp"
#include "program/amber/read/lexer.hpp"

namespace tandem::program::amber {

/// Ends the parsing of a script that no device of ours runs.
struct Unsupported {
  std::string why;
};

/// What every command is read with: tokens, and the draft that it adds to. Reading functions throw ScriptError at the
/// token that is not what has to be there.
class Parser {
 public:
  Parser(std::string_view text, const std::filesystem::path& file) : lexer_(text) { draft_.file = file; }

  Draft& draft() { return draft_; }
  Lexer& lexer() { return lexer_; }

  [[noreturn]] void fail(Position position, const std::string& why) const;
  [[noreturn]] void unsupported(Position position, const std::string& what) const;

  Token next() { return lexer_.next(); }
  bool next_is(std::string_view word) const { return lexer_.peek().is(word); }
  bool at_line_end() const { return lexer_.peek().ends_line(); }
  /// Takes the word if it is next.
  bool take(std::string_view word);
  void expect(std::string_view word);
  /// A word or a number or a string, as text. @param what in the error: "a buffer's name"
  Token name(std::string_view what);
  std::uint64_t whole_number(std::string_view what, std::uint64_t largest = ~std::uint64_t{0});
  std::uint32_t whole_number32(std::string_view what) {
    return static_cast<std::uint32_t>(whole_number(what, ~std::uint32_t{0}));
  }
  Number number(std::string_view what);
  /// on or off.
  bool on_or_off(std::string_view what);
  void end_line(std::string_view command);
  /// The first token of the next line that is not empty; END is taken too. Throws at the end of the script.
  Token next_in_block(std::string_view block);
  /// The text of a block up to END.
  std::string block(std::string_view command, Position position);

  std::size_t shader(std::string_view name, Position position) const;
  std::size_t data(std::string_view name, Position position) const;
  std::size_t sampler(std::string_view name, Position position) const;
  std::size_t bottom_level(std::string_view name, Position position) const;
  std::size_t top_level(std::string_view name, Position position) const;
  std::size_t pipeline(std::string_view name, Position position) const;
  /// A name that nothing of the kind has yet. @param kind "shader", "buffer" ...
  std::string new_name(std::string_view kind);

  /// A type by its name, also that of a STRUCT.
  DataType data_type(const Token& token) const;
  /// A file that the script names, beside it.
  std::filesystem::path beside(const std::string& name) const;

 private:
  Lexer lexer_;
  Draft draft_;
};

// The commands, each after its first word.
void read_shader(Parser& parser);
void read_virtual_file(Parser& parser);
void read_struct(Parser& parser);
void read_buffer(Parser& parser);
void read_image(Parser& parser);
void read_sampler(Parser& parser);
void read_acceleration_structure(Parser& parser);
void read_pipeline(Parser& parser);
void read_derived_pipeline(Parser& parser);
void read_binding(Parser& parser, DraftPipeline& pipeline);
void read_ray_tracing(Parser& parser, DraftPipeline& pipeline, const Token& command);
bool is_ray_tracing_command(std::string_view word);
void read_run(Parser& parser, std::vector<DraftStep>& steps);
void read_copy(Parser& parser, std::vector<DraftStep>& steps);
void read_repeat(Parser& parser, std::vector<DraftStep>& steps);
void read_expectation(Parser& parser, std::vector<DraftStep>& steps);

/// A script of Amber's older language.
Script parse_vkscript(std::string_view text, const std::filesystem::path& file);

/// A command that may stand in REPEAT. False for any other word.
bool read_step(Parser& parser, const Token& command, std::vector<DraftStep>& steps);

/// TOLERANCE's numbers, to the end of them.
std::vector<Tolerance> read_tolerances(Parser& parser);

}  // namespace tandem::program::amber
