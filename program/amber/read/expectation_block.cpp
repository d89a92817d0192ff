#include <fmt/format.h>

#include "program/amber/read/parser.hpp"
#include "program/amber/value/values.hpp"

// EXPECT.
namespace tandem::program::amber {
namespace {

std::optional<Comparison> comparison_of(const Token& token) {
  if (token.is("EQ")) return Comparison::equal;
  if (token.is("NE")) return Comparison::not_equal;
  if (token.is("LT")) return Comparison::less;
  if (token.is("LE")) return Comparison::less_or_equal;
  if (token.is("GT")) return Comparison::greater;
  if (token.is("GE")) return Comparison::greater_or_equal;
  return std::nullopt;
}

double read_distance(Parser& parser) {
  parser.expect("TOLERANCE");
  return parser.number("a tolerance").value;
}

/// EXPECT a EQ_BUFFER b, and so on.
BuffersExpectation read_buffers(Parser& parser, const Token& word, const DraftData& data) {
  BuffersExpectation expected;
  const Token name = parser.name("a buffer or image");
  expected.other = {.index = parser.data(name.text, name.position)};
  const DraftData& other = parser.draft().data[expected.other.index];
  expected.other_name = other.name;
  expected.element = data.layout.type;
  expected.stride = data.layout.stride;
  if (data.bytes.size() != other.bytes.size() || data.layout.stride != other.layout.stride)
    parser.fail(name.position,
                fmt::format("{} has {} bytes in items of {}, {} has {} in items of {}", data.name, data.bytes.size(),
                            data.layout.stride, other.name, other.bytes.size(), other.layout.stride));
  if (word.is("RMSE_BUFFER")) {
    expected.measure = BuffersExpectation::Measure::root_mean_square;
    expected.tolerance = read_distance(parser);
  } else if (word.is("EQ_HISTOGRAM_EMD_BUFFER")) {
    const ValueType& type = data.layout.type;
    if (type.kind != ValueType::Kind::vector || type.rows != 4 || size_of(type.scalar) != 1)
      parser.fail(word.position, fmt::format("{} is not of four 8-bit components", data.name));
    expected.measure = BuffersExpectation::Measure::histogram_earth_movers;
    expected.tolerance = read_distance(parser);
  }
  return expected;
}

TexelsExpectation read_texels(Parser& parser, const DraftData& data, std::array<std::uint64_t, 2> first,
                              Position position) {
  TexelsExpectation expected;
  if (!data.is_image || !data.texel)
    parser.fail(position, fmt::format("{} is no image, so it has no rectangle of texels", data.name));
  expected.texel = *data.texel;
  expected.size = {data.size[0], data.size[1]};
  for (std::size_t i = 0; i < 2; ++i) {
    const Position place = parser.lexer().position();
    const std::uint64_t count = parser.whole_number("a number of texels", 1 << 16);
    if (count == 0 || first[i] + count > expected.size[i])
      parser.fail(
          place, fmt::format("{} texels from {} on are not in {} of {}", count, first[i], expected.size[i], data.name));
    expected.first[i] = static_cast<std::uint32_t>(first[i]);
    expected.count[i] = static_cast<std::uint32_t>(count);
  }
  const Token word = parser.name("EQ_RGB or EQ_RGBA");
  expected.alpha = word.is("EQ_RGBA");
  if (!expected.alpha && !word.is("EQ_RGB"))
    parser.fail(word.position, fmt::format("EQ_RGB or EQ_RGBA is expected, not '{}'", word.text.substr(0, 60)));
  const std::size_t channels = expected.alpha ? 4 : 3;
  for (std::size_t i = 0; i < channels; ++i)
    expected.color[i] = static_cast<std::uint8_t>(parser.whole_number("a value of a colour", 255));
  const Position tolerance_position = parser.lexer().position();
  if (parser.take("TOLERANCE")) expected.tolerances = read_tolerances(parser);
  if (expected.tolerances.size() > channels)
    parser.fail(tolerance_position, fmt::format("a colour has {} tolerances at most", channels));
  parser.end_line("EXPECT");
  return expected;
}

ValuesExpectation read_values(Parser& parser, const DraftData& data, std::uint64_t offset, Position position) {
  ValuesExpectation expected;
  expected.element = data.layout.type;
  expected.stride = data.layout.stride;
  expected.offset = offset;
  const bool has_tolerance = parser.take("TOLERANCE");
  if (has_tolerance) expected.tolerances = read_tolerances(parser);
  const Token word = parser.name("EQ, NE, LT, LE, GT or GE");
  const std::optional<Comparison> comparison = comparison_of(word);
  if (!comparison)
    parser.fail(word.position, fmt::format("EQ, NE, LT, LE, GT or GE is expected, not '{}'", word.text.substr(0, 60)));
  if (has_tolerance && *comparison != Comparison::equal) parser.fail(word.position, "TOLERANCE is only of EQ");
  expected.comparison = *comparison;
  const Values values(expected.element, expected.stride);
  while (!parser.at_line_end()) {
    const Token token = parser.next();
    if (token.kind != Token::Kind::number)
      parser.fail(token.position, fmt::format("a value is expected, not '{}'", token.text.substr(0, 60)));
    const Place place = values.place(expected.values.size());
    if (!fits(token.number, place.scalar))
      parser.fail(token.position, fmt::format("{} is no {}", token.text.substr(0, 60), name_of(place.scalar)));
    const std::uint64_t end = offset + place.offset + size_of(place.scalar);
    if (end > data.bytes.size())
      parser.fail(token.position, fmt::format("the value lies at byte {} of {}, which has {}", offset + place.offset,
                                              data.name, data.bytes.size()));
    expected.values.push_back(token.number);
  }
  if (expected.values.empty()) parser.fail(word.position, "EXPECT has no values");
  if (offset % expected.stride != 0)
    parser.fail(position, fmt::format("IDX {} is no multiple of the {} bytes of an item of {}", offset, expected.stride,
                                      data.name));
  parser.end_line("EXPECT");
  return expected;
}

}  // namespace

std::vector<Tolerance> read_tolerances(Parser& parser) {
  std::vector<Tolerance> tolerances;
  const Position position = parser.lexer().position();
  while (parser.lexer().peek().kind == Token::Kind::number) {
    Tolerance tolerance;
    tolerance.value = parser.number("a tolerance").value;
    tolerance.percent = parser.take("%");
    tolerances.push_back(tolerance);
  }
  if (tolerances.empty() || tolerances.size() > 4) parser.fail(position, "TOLERANCE has 1 to 4 values");
  return tolerances;
}

void read_expectation(Parser& parser, std::vector<DraftStep>& steps) {
  Expectation expectation;
  const Token name = parser.name("a buffer or image");
  expectation.position = name.position;
  expectation.name = name.text;
  expectation.storage = {.index = parser.data(name.text, name.position)};
  const DraftData& data = parser.draft().data[expectation.storage.index];
  const Token word = parser.name("IDX, EQ_BUFFER, RMSE_BUFFER or EQ_HISTOGRAM_EMD_BUFFER");
  if (word.is("EQ_BUFFER") || word.is("RMSE_BUFFER") || word.is("EQ_HISTOGRAM_EMD_BUFFER")) {
    expectation.what = read_buffers(parser, word, data);
    parser.end_line("EXPECT");
  } else if (word.is("IDX")) {
    const Position position = parser.lexer().position();
    std::array<std::uint64_t, 2> first = {parser.whole_number("a position", ~std::uint32_t{0}), 0};
    const bool is_texel = parser.lexer().peek().kind == Token::Kind::number;
    if (is_texel) {
      first[1] = parser.whole_number("a position", ~std::uint32_t{0});
      parser.expect("SIZE");
      expectation.what = read_texels(parser, data, first, position);
    } else {
      expectation.what = read_values(parser, data, first[0], position);
    }
  } else {
    parser.fail(word.position, fmt::format("IDX, EQ_BUFFER, RMSE_BUFFER or EQ_HISTOGRAM_EMD_BUFFER is expected, not "
                                           "'{}'",
                                           word.text.substr(0, 60)));
  }
  steps.emplace_back(DraftExpectation{std::move(expectation)});
}

}  // namespace tandem::program::amber
