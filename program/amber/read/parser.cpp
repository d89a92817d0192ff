#include "program/amber/read/parser.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace tandem::program::amber {
namespace {

std::string text_of(const Token& token) {
  if (token.kind == Token::Kind::end) return "the end of the script";
  if (token.kind == Token::Kind::end_of_line) return "the end of the line";
  constexpr std::size_t longest = 60;
  std::string text = token.text.substr(0, longest);
  for (char& c : text)
    if (c < ' ' || c > '~') c = '?';
  return "'" + text + "'";
}

template <typename List>
std::size_t find(const Parser& parser, const List& list, std::string_view name, std::string_view kind,
                 Position position) {
  const auto name_of = [](const auto& each) -> const std::string& {
    if constexpr (requires { each.name; })
      return each.name;
    else
      return each.label;
  };
  const auto found = std::find_if(list.begin(), list.end(), [&](const auto& each) { return name_of(each) == name; });
  if (found == list.end()) parser.fail(position, fmt::format("there is no {} '{}'", kind, name));
  return static_cast<std::size_t>(found - list.begin());
}

}  // namespace

void Parser::fail(Position position, const std::string& why) const {
  throw ScriptError(draft_.file.string(), position, why);
}

void Parser::unsupported(Position position, const std::string& what) const {
  throw Unsupported{fmt::format("{} (line {})", what, position.line)};
}

bool Parser::take(std::string_view word) {
  if (!next_is(word)) return false;
  next();
  return true;
}

void Parser::expect(std::string_view word) {
  const Token token = next();
  if (!token.is(word)) fail(token.position, fmt::format("{} is expected, not {}", word, text_of(token)));
}

Token Parser::name(std::string_view what) {
  Token token = next();
  if (token.ends_line() || token.text.empty())
    fail(token.position, fmt::format("{} is expected, not {}", what, text_of(token)));
  return token;
}

Number Parser::number(std::string_view what) {
  const Token token = next();
  if (token.kind != Token::Kind::number)
    fail(token.position, fmt::format("{} is expected, not {}", what, text_of(token)));
  return token.number;
}

std::uint64_t Parser::whole_number(std::string_view what, std::uint64_t largest) {
  const Token token = next();
  if (token.kind != Token::Kind::number || token.number.floating || token.number.negative ||
      token.number.bits > largest)
    fail(token.position,
         fmt::format("{} is expected, a whole number{}, not {}", what,
                     largest == ~std::uint64_t{0} ? "" : fmt::format(" of at most {}", largest), text_of(token)));
  return token.number.bits;
}

bool Parser::on_or_off(std::string_view what) {
  const Token token = next();
  if (!token.is("on") && !token.is("off"))
    fail(token.position, fmt::format("{} is on or off, not {}", what, text_of(token)));
  return token.is("on");
}

void Parser::end_line(std::string_view command) {
  const Token token = next();
  if (!token.ends_line()) fail(token.position, fmt::format("{} is too much after {}", text_of(token), command));
}

Token Parser::next_in_block(std::string_view block) {
  for (;;) {
    Token token = next();
    if (token.kind == Token::Kind::end_of_line) continue;
    if (token.kind == Token::Kind::end) fail(token.position, fmt::format("{} has no END", block));
    return token;
  }
}

std::string Parser::block(std::string_view command, Position position) {
  std::string text;
  if (!lexer_.take_block(text)) fail(position, fmt::format("{} has no END", command));
  return text;
}

std::size_t Parser::shader(std::string_view name, Position position) const {
  return find(*this, draft_.shaders, name, "shader", position);
}
std::size_t Parser::data(std::string_view name, Position position) const {
  return find(*this, draft_.data, name, "buffer or image", position);
}
std::size_t Parser::sampler(std::string_view name, Position position) const {
  return find(*this, draft_.samplers, name, "sampler", position);
}
std::size_t Parser::bottom_level(std::string_view name, Position position) const {
  return find(*this, draft_.bottom_levels, name, "bottom level", position);
}
std::size_t Parser::top_level(std::string_view name, Position position) const {
  return find(*this, draft_.top_levels, name, "top level", position);
}
std::size_t Parser::pipeline(std::string_view name, Position position) const {
  return find(*this, draft_.pipelines, name, "pipeline", position);
}

std::string Parser::new_name(std::string_view kind) {
  const Token token = name(fmt::format("the {}'s name", kind));
  const auto is_same = [&](const auto& each) { return each.name == token.text; };
  const auto is_same_label = [&](const auto& each) { return each.label == token.text; };
  const bool taken = kind == "shader"     ? std::any_of(draft_.shaders.begin(), draft_.shaders.end(), is_same)
                     : kind == "pipeline" ? std::any_of(draft_.pipelines.begin(), draft_.pipelines.end(), is_same)
                     : kind == "struct"   ? draft_.structs.contains(token.text)
                     : kind == "sampler"  ? std::any_of(draft_.samplers.begin(), draft_.samplers.end(), is_same_label)
                     : kind == "bottom level"
                         ? std::any_of(draft_.bottom_levels.begin(), draft_.bottom_levels.end(), is_same)
                     : kind == "top level" ? std::any_of(draft_.top_levels.begin(), draft_.top_levels.end(), is_same)
                                           : std::any_of(draft_.data.begin(), draft_.data.end(), is_same);
  if (taken) fail(token.position, fmt::format("there is a {} '{}' already", kind, token.text));
  return token.text;
}

DataType Parser::data_type(const Token& token) const {
  const std::size_t bracket = token.text.find('[');
  const auto found = draft_.structs.find(token.text.substr(0, bracket));
  if (found != draft_.structs.end()) {
    DataType type;
    if (bracket != std::string::npos) {
      // The brackets are those of any type.
      const auto array = parse_data_type("uint32" + token.text.substr(bracket));
      if (!array) fail(token.position, fmt::format("{} is no type", text_of(token)));
      type = *array;
    }
    type.structure = found->second;
    return type;
  }
  const std::optional<DataType> type = parse_data_type(token.text);
  if (!type) fail(token.position, fmt::format("{} is no type", text_of(token)));
  return *type;
}

std::filesystem::path Parser::beside(const std::string& name) const { return draft_.file.parent_path() / name; }

}  // namespace tandem::program::amber
