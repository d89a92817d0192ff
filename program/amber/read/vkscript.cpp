#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "program/amber/read/parser.hpp"
#include "program/amber/value/values.hpp"

// VkScript, Amber's older language: sections in brackets, one compute shader, and buffers that have no names but their
// places.
namespace tandem::program::amber {
namespace {

constexpr std::uint64_t largest_buffer = std::uint64_t{1} << 28;

/// Amber's name of a type of VkScript, "vec3<float>" for "vec3"; "" for a word that is none.
std::string type_name(std::string_view word) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 11> scalars = {{{"int", "int32"},
                                                                                      {"uint", "uint32"},
                                                                                      {"int8_t", "int8"},
                                                                                      {"uint8_t", "uint8"},
                                                                                      {"int16_t", "int16"},
                                                                                      {"uint16_t", "uint16"},
                                                                                      {"int64_t", "int64"},
                                                                                      {"uint64_t", "uint64"},
                                                                                      {"float16_t", "float16"},
                                                                                      {"float", "float"},
                                                                                      {"double", "double"}}};
  constexpr std::array<std::pair<std::string_view, std::string_view>, 11> prefixes = {{{"", "float"},
                                                                                       {"d", "double"},
                                                                                       {"f16", "float16"},
                                                                                       {"i", "int32"},
                                                                                       {"u", "uint32"},
                                                                                       {"i8", "int8"},
                                                                                       {"u8", "uint8"},
                                                                                       {"i16", "int16"},
                                                                                       {"u16", "uint16"},
                                                                                       {"i64", "int64"},
                                                                                       {"u64", "uint64"}}};
  for (const auto& [name, amber] : scalars)
    if (word == name) return std::string(amber);
  for (const auto& [prefix, amber] : prefixes) {
    if (!word.starts_with(prefix)) continue;
    std::string_view shape = word.substr(prefix.size());
    if (shape.starts_with("vec") && shape.size() == 4) return fmt::format("{}<{}>", shape, amber);
    if (shape.starts_with("mat") && shape.size() == 4) return fmt::format("{}x{}<{}>", shape, shape.back(), amber);
    if (shape.starts_with("mat") && shape.size() == 6) return fmt::format("{}<{}>", shape, amber);
  }
  return "";
}

/// What is written or probed: values of a type from a byte on.
struct Written {
  LaidOut layout;
  std::uint64_t offset = 0;
  std::vector<Number> numbers;
};

class VkScript {
 public:
  VkScript(std::string_view text, const std::filesystem::path& file) : parser_(text, file) {
    pipeline_.name = "compute";
    stage_.stage = rhi::ShaderStage::compute;
  }

  Script read() {
    try {
      for (Token token = parser_.next(); token.kind != Token::Kind::end; token = parser_.next())
        if (token.kind != Token::Kind::end_of_line) read_line(token);
      return assembled();
    } catch (const Unsupported& reason) {
      Script script;
      script.file = parser_.draft().file;
      script.requirements = parser_.draft().requirements;
      script.unsupported = reason.why;
      return script;
    }
  }

 private:
  void read_line(const Token& token) {
    if (token.text.starts_with('[')) return read_section(token);
    if (section_ == "require") return read_requirement(token);
    if (section_ == "test") return read_command(token);
    parser_.fail(token.position, fmt::format("'{}' stands in no section", token.text.substr(0, 60)));
  }

  /// "[test]", "[compute shader spirv]".
  void read_section(const Token& first) {
    std::string name = first.text;
    while (!parser_.at_line_end()) name += " " + parser_.next().text;
    if (!name.ends_with(']'))
      parser_.fail(first.position, fmt::format("the section '{}' has no ]", name.substr(0, 60)));
    section_ = name.substr(1, name.size() - 2);
    parser_.end_line("the section");
    if (section_ == "require" || section_ == "test") return;
    const bool is_compute = section_.starts_with("compute shader");
    if (!is_compute) parser_.unsupported(first.position, "a graphics pipeline");
    if (!parser_.draft().shaders.empty()) parser_.fail(first.position, "there is a compute shader already");
    DraftShader shader;
    shader.name = "compute";
    shader.stage = rhi::ShaderStage::compute;
    shader.source.position = first.position;
    shader.source.text_position = {first.position.line + 1, 1};
    if (section_ == "compute shader spirv")
      shader.source.language = Language::spirv_assembly;
    else if (section_ == "compute shader")
      shader.source.language = Language::glsl;
    else
      parser_.unsupported(first.position, fmt::format("the section '{}'", section_.substr(0, 60)));
    shader.source.text = parser_.lexer().take_lines_to('[');
    parser_.draft().shaders.push_back(std::move(shader));
    section_.clear();
  }

  void read_requirement(const Token& name) {
    if (name.is("framebuffer") || name.is("depthstencil") || name.is("fbsize"))
      parser_.unsupported(name.position, "a graphics pipeline");
    Requirement requirement = {Requirement::Kind::device_extension, name.text, name.position};
    if (!name.text.starts_with("VK_")) {
      requirement.kind = Requirement::Kind::feature;
      if (!is_known(requirement.kind, name.text))
        parser_.fail(name.position, fmt::format("'{}' is no device feature that Amber knows", name.text.substr(0, 80)));
    } else if (name.text == "VK_KHR_get_physical_device_properties2") {
      requirement.kind = Requirement::Kind::instance_extension;
    }
    parser_.draft().requirements.push_back(std::move(requirement));
    parser_.end_line("the requirement");
  }

  void read_command(const Token& command) {
    if (command.is("compute")) {
      read_compute(command);
    } else if (command.is("ssbo")) {
      read_storage();
    } else if (command.is("uniform")) {
      read_uniform();
    } else if (command.is("probe")) {
      read_probe(command);
    } else if (command.is("tolerance")) {
      tolerances_ = read_tolerances(parser_);
    } else {
      parser_.unsupported(command.position, fmt::format("the command '{}'", command.text.substr(0, 60)));
    }
    parser_.end_line("the command");
  }

  void read_compute(const Token& command) {
    if (parser_.take("entrypoint")) {
      if (has_run_) parser_.unsupported(command.position, "an entry point after a run");
      stage_.entry_point = parser_.name("an entry point").text;
      return;
    }
    if (parser_.draft().shaders.empty()) parser_.fail(command.position, "there is no compute shader");
    DraftRun run;
    run.position = command.position;
    for (std::uint32_t& side : run.size) side = parser_.whole_number32("a number of workgroups");
    parser_.draft().steps.emplace_back(run);
    has_run_ = true;
  }

  /// "3" is binding 3 of set 0, "1:3" of set 1.
  std::size_t read_place(std::string_view kind) {
    DraftBinding binding;
    const Token token = parser_.next();
    // The lexer cuts "1:3" in two: a number ends at what is none.
    if (token.kind != Token::Kind::number || token.number.floating || token.number.negative)
      parser_.fail(token.position, fmt::format("a binding is expected, not '{}'", token.text.substr(0, 60)));
    binding.binding = static_cast<std::uint32_t>(token.number.bits);
    const Token rest = parser_.lexer().peek();
    if (rest.kind == Token::Kind::word && rest.text.starts_with(':')) {
      parser_.next();
      const auto number = parse_number(std::string_view(rest.text).substr(1));
      if (!number || number->floating || number->negative)
        parser_.fail(rest.position, fmt::format("'{}' is no binding", rest.text.substr(0, 60)));
      binding.set = binding.binding;
      binding.binding = static_cast<std::uint32_t>(number->bits);
    }
    const auto [entry, is_new] = places_.try_emplace({binding.set, binding.binding}, parser_.draft().data.size());
    if (is_new) {
      DraftData data;
      data.name = fmt::format("{} {}:{}", kind, binding.set, binding.binding);
      data.position = token.position;
      data.layout = lay_out(*parse_data_type("int8"), Layout::std430);
      data.bound_as_buffer = true;
      binding.index = entry->second;
      parser_.draft().data.push_back(std::move(data));
      pipeline_.bindings.push_back(binding);
    }
    return entry->second;
  }

  LaidOut read_type() {
    const Token token = parser_.name("a type");
    const auto type = parse_data_type(type_name(token.text));
    if (!type) parser_.fail(token.position, fmt::format("'{}' is no type", token.text.substr(0, 60)));
    return lay_out(*type, Layout::std430);
  }

  Written read_numbers(LaidOut layout) {
    Written written;
    written.layout = std::move(layout);
    const Values values(written.layout.type, written.layout.stride);
    while (!parser_.at_line_end()) {
      const Token token = parser_.lexer().peek();
      const Number number = parser_.number("a value");
      const ScalarType scalar = values.place(written.numbers.size()).scalar;
      if (!fits(number, scalar))
        parser_.fail(token.position, fmt::format("{} is no {}", token.text.substr(0, 60), name_of(scalar)));
      written.numbers.push_back(number);
    }
    if (written.numbers.empty()) parser_.fail(parser_.lexer().position(), "a value is expected");
    return written;
  }

  /// A type, an offset and values.
  Written read_written() {
    LaidOut layout = read_type();
    const std::uint64_t offset = parser_.whole_number("an offset", largest_buffer);
    Written written = read_numbers(std::move(layout));
    written.offset = offset;
    return written;
  }

  void store(std::size_t index, const Written& written, Position position) {
    if (has_run_) parser_.unsupported(position, "data that is written after a run");
    DraftData& data = parser_.draft().data[index];
    set_type(index, written.layout);
    const Values values(written.layout.type, written.layout.stride);
    const std::vector<std::byte> bytes = bytes_of(written.numbers, values, written.layout.stride);
    const std::uint64_t end = written.offset + bytes.size();
    if (end > largest_buffer) parser_.fail(position, "a buffer of more than 256 MiB is too large");
    if (data.bytes.size() < end) data.bytes.resize(end);
    for (std::size_t i = 0; i < written.numbers.size(); ++i) {
      const Place place = values.place(i);
      write(std::span(data.bytes).subspan(written.offset + place.offset), place.scalar, written.numbers[i]);
    }
  }

  /// The type of what is first written or probed is that of the buffer.
  void set_type(std::size_t index, const LaidOut& layout) {
    if (typed_.insert(index).second) parser_.draft().data[index].layout = layout;
  }

  void read_storage() {
    const Position position = parser_.lexer().position();
    const std::size_t index = read_place("ssbo");
    if (parser_.take("subdata")) return store(index, read_written(), position);
    counts_[index] = parser_.whole_number("a number of items", largest_buffer);
  }

  void read_uniform() {
    const Position position = parser_.lexer().position();
    if (parser_.take("ubo")) {
      const std::size_t index = read_place("ubo");
      return store(index, read_written(), position);
    }
    if (!pipeline_.push_constants) {
      pipeline_.push_constants = parser_.draft().data.size();
      DraftData data;
      data.name = "push constants";
      data.bound_as_buffer = true;
      parser_.draft().data.push_back(std::move(data));
    }
    store(*pipeline_.push_constants, read_written(), position);
  }

  void read_probe(const Token& command) {
    if (!parser_.take("ssbo")) parser_.unsupported(command.position, "a probe of a framebuffer");
    Expectation expectation;
    expectation.position = command.position;
    LaidOut layout = read_type();
    const std::size_t index = read_place("ssbo");
    set_type(index, layout);
    expectation.storage.index = index;
    expectation.name = parser_.draft().data[index].name;
    ValuesExpectation expected;
    expected.offset = parser_.whole_number("an offset", largest_buffer);
    const Token word = parser_.name("a comparison");
    constexpr std::array<std::pair<std::string_view, Comparison>, 7> comparisons = {
        {{"==", Comparison::equal},
         {"!=", Comparison::not_equal},
         {"<", Comparison::less},
         {"<=", Comparison::less_or_equal},
         {">", Comparison::greater},
         {">=", Comparison::greater_or_equal},
         {"~=", Comparison::equal}}};
    const auto found =
        std::find_if(comparisons.begin(), comparisons.end(), [&](const auto& each) { return word.is(each.first); });
    if (found == comparisons.end())
      parser_.fail(word.position, fmt::format("'{}' is no comparison", word.text.substr(0, 60)));
    expected.comparison = found->second;
    if (word.is("~=")) expected.tolerances = tolerances_;
    expected.element = layout.type;
    expected.stride = layout.stride;
    expected.values = read_numbers(std::move(layout)).numbers;
    expectation.what = std::move(expected);
    parser_.draft().steps.emplace_back(DraftExpectation{std::move(expectation)});
  }

  Script assembled() {
    Draft& draft = parser_.draft();
    if (draft.shaders.empty()) parser_.unsupported({}, "a script without a compute shader");
    for (std::size_t i = 0; i < draft.data.size(); ++i) {
      DraftData& data = draft.data[i];
      const auto count = counts_.find(i);
      const std::uint64_t size = count == counts_.end() ? 0 : count->second * data.layout.stride;
      if (size > largest_buffer) parser_.fail(data.position, "a buffer of more than 256 MiB is too large");
      data.bytes.resize(std::max<std::uint64_t>({data.bytes.size(), size, 4}));
    }
    pipeline_.stages = {stage_};
    draft.pipelines.push_back(std::move(pipeline_));
    return assemble(std::move(draft));
  }

  Parser parser_;
  std::string section_;
  DraftPipeline pipeline_;
  DraftStage stage_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> places_;  ///< data by set and binding
  std::map<std::size_t, std::uint64_t> counts_;                            ///< items by data
  std::set<std::size_t> typed_;                                            ///< data whose type is known
  std::vector<Tolerance> tolerances_ = {{.value = 1e-6, .percent = true}};
  bool has_run_ = false;
};

}  // namespace

Script parse_vkscript(std::string_view text, const std::filesystem::path& file) { return VkScript(text, file).read(); }

}  // namespace tandem::program::amber
