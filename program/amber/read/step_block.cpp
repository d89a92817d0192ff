#include <fmt/format.h>

#include <algorithm>

#include "program/amber/read/parser.hpp"

// RUN, COPY and REPEAT.
namespace tandem::program::amber {
namespace {

/// The tables of a trace, each a word and a name, in any order. Returns at the first number.
void read_tables(Parser& parser, const DraftPipeline& pipeline, DraftRun& run) {
  constexpr std::array<std::string_view, 4> words = {"RAYGEN", "MISS", "HIT", "CALL"};
  while (parser.lexer().peek().kind == Token::Kind::word) {
    const Token word = parser.next();
    const auto found = std::find_if(words.begin(), words.end(), [&](std::string_view each) { return word.is(each); });
    if (found == words.end())
      parser.fail(word.position,
                  fmt::format("RAYGEN, MISS, HIT or CALL is expected, not '{}'", word.text.substr(0, 60)));
    const Token name = parser.name("a shader binding table");
    const auto table = std::find_if(pipeline.tables.begin(), pipeline.tables.end(),
                                    [&](const DraftTable& each) { return each.name == name.text; });
    if (table == pipeline.tables.end())
      parser.fail(name.position, fmt::format("there is no shader binding table '{}' in {}", name.text, pipeline.name));
    run.tables[static_cast<std::size_t>(found - words.begin())] =
        static_cast<std::size_t>(table - pipeline.tables.begin());
  }
  if (!run.tables[0]) parser.fail(run.position, "RUN of a ray tracing pipeline has no RAYGEN");
}

}  // namespace

void read_run(Parser& parser, std::vector<DraftStep>& steps) {
  DraftRun run;
  run.position = parser.lexer().position();
  parser.take("TIMED_EXECUTION");
  const Token name = parser.name("a pipeline");
  run.pipeline = parser.pipeline(name.text, name.position);
  const DraftPipeline& pipeline = parser.draft().pipelines[run.pipeline];
  if (pipeline.library) parser.fail(name.position, fmt::format("{} is a library", pipeline.name));
  if (pipeline.ray_tracing) {
    read_tables(parser, pipeline, run);
  } else if (pipeline.stages.empty()) {
    parser.fail(name.position, fmt::format("the compute pipeline {} has no shader", pipeline.name));
  }
  for (std::uint32_t& side : run.size)
    side = parser.whole_number32(pipeline.ray_tracing ? "a number of rays" : "a number of workgroups");
  parser.end_line("RUN");
  steps.emplace_back(run);
}

void read_copy(Parser& parser, std::vector<DraftStep>& steps) {
  DraftCopy copy;
  const Token from = parser.name("a buffer or image");
  copy.position = from.position;
  copy.from = parser.data(from.text, from.position);
  parser.expect("TO");
  const Token to = parser.name("a buffer or image");
  copy.to = parser.data(to.text, to.position);
  const DraftData& source = parser.draft().data[copy.from];
  const DraftData& destination = parser.draft().data[copy.to];
  if (copy.from == copy.to) parser.fail(to.position, fmt::format("{} is copied to itself", from.text));
  if (source.bytes.size() != destination.bytes.size())
    parser.fail(from.position, fmt::format("{} has {} bytes, {} has {}", source.name, source.bytes.size(),
                                           destination.name, destination.bytes.size()));
  parser.end_line("COPY");
  steps.emplace_back(copy);
}

void read_repeat(Parser& parser, std::vector<DraftStep>& steps) {
  DraftRepeat repeat;
  repeat.position = parser.lexer().position();
  repeat.count = parser.whole_number32("a count");
  parser.end_line("REPEAT");
  for (Token command = parser.next_in_block("REPEAT"); !command.is("END"); command = parser.next_in_block("REPEAT"))
    if (!read_step(parser, command, repeat.steps))
      parser.fail(command.position, fmt::format("'{}' is no command of REPEAT", command.text.substr(0, 60)));
  parser.end_line("END");
  steps.emplace_back(std::move(repeat));
}

bool read_step(Parser& parser, const Token& command, std::vector<DraftStep>& steps) {
  if (command.is("RUN")) {
    read_run(parser, steps);
  } else if (command.is("COPY")) {
    read_copy(parser, steps);
  } else if (command.is("EXPECT")) {
    read_expectation(parser, steps);
  } else {
    return false;
  }
  return true;
}

}  // namespace tandem::program::amber
