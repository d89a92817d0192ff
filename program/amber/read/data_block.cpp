#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/input_file.hpp"
#include "program/amber/read/parser.hpp"
#include "program/amber/value/values.hpp"

// STRUCT, BUFFER and IMAGE.
namespace tandem::program::amber {
namespace {

constexpr std::uint64_t largest_data = std::uint64_t{1} << 30;
/// What a buffer or image has that takes its size from a framebuffer.
constexpr std::uint32_t usual_framebuffer_size = 250;

void check_size(const Parser& parser, std::uint64_t items, std::uint32_t stride, Position position) {
  if (items == 0) parser.fail(position, "no items are no buffer");
  if (items > largest_data / stride) parser.fail(position, "a buffer or image of more than 1 GiB is too large");
}

/// The next number, of which FILL and SERIES_FROM allow an integer to be written as 0.0.
Number read_for(Parser& parser, const Values& values, std::string_view what) {
  const Token token = parser.lexer().peek();
  Number number = parser.number(what);
  constexpr double largest = 9007199254740992.0;  // up to which every integer is a double
  const bool is_whole =
      number.floating && number.value == std::trunc(number.value) && std::fabs(number.value) <= largest;
  for (std::size_t i = 0; i < values.scalars_per_element(); ++i) {
    const ScalarType scalar = values.place(i).scalar;
    if (is_whole && !is_floating(scalar)) {
      number.floating = false;
      number.negative = number.value < 0;
      number.bits = static_cast<std::uint64_t>(static_cast<std::int64_t>(number.value));
    }
    if (!fits(number, scalar))
      parser.fail(token.position, fmt::format("{} is no {}", token.text.substr(0, 60), name_of(scalar)));
  }
  return number;
}

/// Numbers up to END, or of a file up to its end.
std::vector<Number> read_numbers(Parser& parser, Lexer& lexer, const Values& values, bool to_end,
                                 std::optional<Position> in_file) {
  std::vector<Number> numbers;
  for (;;) {
    const Token token = lexer.next();
    const Position position = in_file.value_or(token.position);
    if (token.kind == Token::Kind::end_of_line || token.is(",")) continue;
    if (token.kind == Token::Kind::end && to_end) return numbers;
    if (token.kind == Token::Kind::end) parser.fail(position, "DATA has no END");
    if (token.is("END") && !to_end) return numbers;
    if (token.kind != Token::Kind::number)
      parser.fail(position, fmt::format("a number is expected, not '{}'", token.text.substr(0, 60)));
    const ScalarType scalar = values.place(numbers.size() % values.scalars_per_element()).scalar;
    // Of an integer that is too large the lowest bits are stored: scripts of the CTS have such data.
    if (token.number.floating && !fits(token.number, scalar))
      parser.fail(position, fmt::format("{} is no {}", token.text.substr(0, 60), name_of(scalar)));
    numbers.push_back(token.number);
  }
}

void read_file(Parser& parser, DraftData& data, const Values& values) {
  Token kind = parser.name("TEXT, BINARY or PNG");
  if (kind.is("PNG") || (!kind.is("TEXT") && !kind.is("BINARY")))
    parser.unsupported(kind.position, "data from a PNG file");
  const Token name = parser.name("a file's name");
  std::string text;
  try {
    text = read_bytes(parser.beside(name.text), largest_data);
  } catch (const Error& error) {
    parser.fail(name.position, error.what());
  }
  if (kind.is("BINARY")) {
    const auto bytes = std::as_bytes(std::span(text));
    data.bytes.assign(bytes.begin(), bytes.end());
    return;
  }
  Lexer lexer(text);
  data.bytes = bytes_of(read_numbers(parser, lexer, values, true, name.position), values, data.layout.stride);
}

void fill(DraftData& data, const Values& values, std::uint64_t items, const Number& number) {
  const std::vector<Number> numbers(values.scalars_per_element(), number);
  const std::vector<std::byte> item = bytes_of(numbers, values, data.layout.stride);
  data.bytes.resize(items * item.size());
  for (std::uint64_t i = 0; i < items; ++i)
    std::copy(item.begin(), item.end(), data.bytes.begin() + static_cast<std::ptrdiff_t>(i * item.size()));
}

void fill_with_series(Parser& parser, DraftData& data, const Values& values, std::uint64_t items) {
  Number number = read_for(parser, values, "the first value");
  parser.expect("INC_BY");
  const Number increment = read_for(parser, values, "the increment");
  data.bytes.resize(items * data.layout.stride);
  const std::uint64_t count = items * values.scalars_per_element();
  for (std::uint64_t i = 0; i < count; ++i) {
    const Place place = values.place(i);
    // Integers wrap.
    write(std::span(data.bytes).subspan(place.offset), place.scalar, number);
    number.bits += increment.bits;
    number.value += increment.value;
    number.negative = false;
  }
}

/// FILL, SERIES_FROM, DATA or FILE. @param items empty: as many as DATA has. False when the line ends instead.
bool read_initializer(Parser& parser, DraftData& data, std::optional<std::uint64_t> items) {
  const Values values(data.layout.type, data.layout.stride);
  const Token word = parser.next();
  if (word.ends_line()) return false;
  if (word.is("DATA")) {
    const std::vector<Number> numbers = read_numbers(parser, parser.lexer(), values, false, {});
    data.bytes = bytes_of(numbers, values, data.layout.stride);
    if (numbers.empty()) parser.fail(word.position, fmt::format("the data of {} is empty", data.name));
  } else if (word.is("FILL") && items) {
    fill(data, values, *items, read_for(parser, values, "a value"));
  } else if (word.is("SERIES_FROM") && items) {
    fill_with_series(parser, data, values, *items);
  } else if (word.is("FILE")) {
    read_file(parser, data, values);
  } else {
    parser.fail(word.position, fmt::format("DATA{} or FILE is expected, not '{}'",
                                           items ? ", FILL, SERIES_FROM" : ", SIZE", word.text.substr(0, 60)));
  }
  parser.end_line(word.text);
  return true;
}

void set_type(Parser& parser, DraftData& data, Layout layout, Position position) {
  try {
    data.layout = lay_out(data.type, layout);
  } catch (const Error& error) {
    parser.fail(position, error.what());
  }
  if (data.layout.stride == 0) parser.fail(position, "a type without a size is none of a buffer");
  data.texel = data.type.texel;
  if (!data.texel && !data.type.structure && !data.type.is_array) data.texel = texel_of(data.layout.type);
}

void set_format(Parser& parser, DraftData& data) {
  const Token format = parser.name("a format");
  const std::optional<DataType> type = parse_data_type(format.text);
  if (!type || !type->texel) parser.fail(format.position, fmt::format("'{}' is no format", format.text));
  data.type = *type;
  set_type(parser, data, Layout::std430, format.position);
}

std::uint32_t sample_count(Parser& parser) {
  const Position position = parser.lexer().position();
  const std::uint32_t samples = parser.whole_number32("a number of samples");
  if (samples == 0 || samples > 64 || (samples & (samples - 1)) != 0)
    parser.fail(position, "SAMPLES is 1, 2, 4, 8, 16, 32 or 64");
  return samples;
}

/// One value where the size alone is given.
void fill_with_zeros(DraftData& data, std::uint64_t items) {
  data.bytes.assign(items * data.layout.stride, std::byte{0});
}

/// BUFFER name FORMAT: an image of the framebuffer's size.
void read_format_buffer(Parser& parser, DraftData& data) {
  set_format(parser, data);
  data.is_image = true;
  data.of_framebuffer_size = true;
  data.size = {usual_framebuffer_size, usual_framebuffer_size, 1};
  for (Token word = parser.next(); !word.ends_line(); word = parser.next()) {
    if (word.is("MIP_LEVELS")) {
      data.level_count = parser.whole_number32("a number of levels");
    } else if (word.is("SAMPLES")) {
      data.samples = sample_count(parser);
    } else if (word.is("FILE")) {
      parser.unsupported(word.position, "data from a PNG file");
    } else {
      parser.fail(word.position, fmt::format("'{}' is no option of BUFFER FORMAT", word.text.substr(0, 60)));
    }
  }
  fill_with_zeros(data, std::uint64_t{data.size[0]} * data.size[1]);
}

std::uint32_t side(Parser& parser, std::string_view what) {
  const Position position = parser.lexer().position();
  const std::uint32_t length = parser.whole_number32(what);
  if (length == 0 || length > 1 << 16) parser.fail(position, fmt::format("{} is from 1 to 65536", what));
  return length;
}

}  // namespace

void read_struct(Parser& parser) {
  auto declared = std::make_shared<Struct>();
  const Position position = parser.lexer().position();
  declared->name = parser.new_name("struct");
  if (parser.take("STRIDE")) declared->stride = parser.whole_number32("the stride");
  parser.end_line("STRUCT");
  for (Token word = parser.next_in_block("STRUCT"); !word.is("END"); word = parser.next_in_block("STRUCT")) {
    StructMember member;
    member.type = parser.data_type(word);
    if (member.type.is_array && member.type.count == 0)
      parser.fail(word.position, "an array without a length is none of a struct");
    const Token name = parser.name("the member's name");
    member.name = name.text;
    for (const StructMember& other : declared->members)
      if (other.name == member.name)
        parser.fail(name.position, fmt::format("there is a member '{}' already", member.name));
    for (Token option = parser.next(); !option.ends_line(); option = parser.next()) {
      std::optional<std::uint32_t>* const value = option.is("OFFSET")          ? &member.offset
                                                  : option.is("ARRAY_STRIDE")  ? &member.array_stride
                                                  : option.is("MATRIX_STRIDE") ? &member.matrix_stride
                                                                               : nullptr;
      if (value == nullptr)
        parser.fail(option.position, fmt::format("'{}' is no option of a member: OFFSET, ARRAY_STRIDE or "
                                                 "MATRIX_STRIDE",
                                                 option.text.substr(0, 60)));
      if (value == &member.array_stride && !member.type.is_array)
        parser.fail(option.position, fmt::format("{} is no array", member.name));
      if (value == &member.matrix_stride && member.type.columns == 1)
        parser.fail(option.position, fmt::format("{} is no matrix", member.name));
      *value = parser.whole_number32("a number of bytes");
    }
    declared->members.push_back(std::move(member));
  }
  parser.end_line("END");
  if (declared->members.empty()) parser.fail(position, fmt::format("the struct {} has no members", declared->name));
  parser.draft().structs.emplace(declared->name, declared);
}

void read_buffer(Parser& parser) {
  DraftData data;
  data.position = parser.lexer().position();
  data.name = parser.new_name("buffer");
  if (parser.take("FORMAT")) {
    read_format_buffer(parser, data);
    parser.draft().data.push_back(std::move(data));
    return;
  }
  parser.expect("DATA_TYPE");
  const Token type = parser.name("a type");
  data.type = parser.data_type(type);
  Layout layout = Layout::std430;
  if (parser.take("STD140")) {
    layout = Layout::std140;
  } else if (parser.take("SCALAR")) {
    layout = Layout::scalar;
  } else {
    parser.take("STD430");
  }
  set_type(parser, data, layout, type.position);
  std::optional<std::uint64_t> items;
  const Position size_position = parser.lexer().position();
  if (parser.take("SIZE")) {
    items = parser.whole_number32("a number of items");
  } else if (parser.take("WIDTH")) {
    data.is_image = true;
    data.size[0] = side(parser, "WIDTH");
    parser.expect("HEIGHT");
    data.size[1] = side(parser, "HEIGHT");
    items = std::uint64_t{data.size[0]} * data.size[1];
  }
  if (items) check_size(parser, *items, data.layout.stride, size_position);
  if (!read_initializer(parser, data, items)) {
    if (!data.is_image) parser.fail(size_position, fmt::format("{} has no initial data", data.name));
    fill_with_zeros(data, *items);
  }
  if (items && data.bytes.size() < *items * data.layout.stride) data.bytes.resize(*items * data.layout.stride);
  if (data.bytes.empty()) parser.fail(size_position, fmt::format("{} is empty", data.name));
  parser.draft().data.push_back(std::move(data));
}

void read_image(Parser& parser) {
  DraftData data;
  data.is_image = true;
  data.position = parser.lexer().position();
  data.name = parser.new_name("image");
  std::array<bool, 3> given = {};
  bool has_type = false;
  for (Token word = parser.lexer().peek(); !word.ends_line(); word = parser.lexer().peek()) {
    if (word.is("DATA") || word.is("FILL") || word.is("SERIES_FROM") || word.is("FILE")) break;
    parser.next();
    if (word.is("DATA_TYPE")) {
      const Token type = parser.name("a type");
      data.type = parser.data_type(type);
      set_type(parser, data, Layout::std430, type.position);
      has_type = true;
    } else if (word.is("FORMAT")) {
      set_format(parser, data);
      has_type = true;
    } else if (word.is("MIP_LEVELS")) {
      data.level_count = parser.whole_number32("a number of levels");
    } else if (word.is("SAMPLES")) {
      data.samples = sample_count(parser);
    } else if (word.is("DIM_1D")) {
      data.dimension = rhi::TextureDimension::d1;
    } else if (word.is("DIM_2D")) {
      data.dimension = rhi::TextureDimension::d2;
    } else if (word.is("DIM_3D")) {
      data.dimension = rhi::TextureDimension::d3;
    } else if (word.is("WIDTH") || word.is("HEIGHT") || word.is("DEPTH")) {
      const std::size_t i = word.is("WIDTH") ? 0 : word.is("HEIGHT") ? 1 : 2;
      data.size[i] = side(parser, word.text);
      given[i] = true;
    } else {
      parser.fail(word.position, fmt::format("'{}' is no option of IMAGE", word.text.substr(0, 60)));
    }
  }
  if (!has_type) parser.fail(data.position, fmt::format("the image {} has no FORMAT", data.name));
  const std::uint32_t sides = rhi::side_count(data.dimension);
  constexpr std::array<std::string_view, 3> words = {"WIDTH", "HEIGHT", "DEPTH"};
  for (std::size_t i = 0; i < sides; ++i)
    if (!given[i]) parser.fail(data.position, fmt::format("the image {} has no {}", data.name, words[i]));
  for (std::size_t i = sides; i < 3; ++i) data.size[i] = 1;
  const std::uint64_t items = std::uint64_t{data.size[0]} * data.size[1] * data.size[2];
  check_size(parser, items, data.layout.stride, data.position);
  if (!read_initializer(parser, data, items)) fill_with_zeros(data, items);
  if (data.bytes.size() != items * data.layout.stride)
    parser.fail(data.position, fmt::format("the image {} has {} texels, its data {}", data.name, items,
                                           data.bytes.size() / data.layout.stride));
  parser.draft().data.push_back(std::move(data));
}

}  // namespace tandem::program::amber
