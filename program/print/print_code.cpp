#include "program/print/print_code.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <optional>
#include <unordered_set>

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/printable.hpp"
#include "program/record/word_code.hpp"
#include "rhi/error.hpp"
#include "rhi/spirv/words.hpp"

namespace tandem::program {
namespace {

constexpr std::string_view print_set = "NonSemantic.DebugPrintf";
constexpr std::string_view set_prefix = "NonSemantic.";
constexpr std::string_view non_semantic_extension = "SPV_KHR_non_semantic_info";
/// Words of OpExtInst in front of DebugPrintf's format.
constexpr std::size_t format_word = 5;
constexpr std::uint32_t debug_printf = 1;
/// A call's number and its invocation.
constexpr std::uint32_t words_before_arguments = 4;
constexpr std::uint32_t most_calls = 1u << 31;

std::string literal(std::span<const std::uint32_t> words) {
  const auto* const characters = reinterpret_cast<const char*>(words.data());
  const std::size_t size = words.size_bytes();
  return {characters, std::find(characters, characters + size, '\0')};
}

bool imports(const Instruction& instruction, std::string_view set) {
  return instruction.op == spv::OpExtInstImport && literal(std::span(instruction.words).subspan(2)) == set;
}

/// Copies a module without its calls, or with code in their place.
class Rewriter {
 public:
  Rewriter(std::span<const std::uint32_t> spirv, std::string_view label) : module_(parse_module(spirv, label)) {
    bool has_other_sets = false;
    for (const Instruction& instruction : module_.instructions) {
      if (imports(instruction, print_set))
        sets_.insert(instruction.result);
      else if (instruction.op == spv::OpExtInstImport)
        has_other_sets |= literal(std::span(instruction.words).subspan(2)).starts_with(set_prefix);
    }
    keeps_extension_ = has_other_sets;
    for (const Instruction& instruction : module_.instructions)
      if (is_call(instruction)) removed_.insert(instruction.result);
    removed_.insert(sets_.begin(), sets_.end());
  }

  const Module& module() const noexcept { return module_; }

  bool is_call(const Instruction& instruction) const {
    return instruction.op == spv::OpExtInst && sets_.contains(instruction.words[3]) &&
           instruction.words[4] == debug_printf && instruction.words.size() > format_word;
  }

  bool is_kept(const Instruction& instruction) const {
    switch (instruction.op) {
      case spv::OpExtension:
        return keeps_extension_ || literal(std::span(instruction.words).subspan(1)) != non_semantic_extension;
      case spv::OpName:
      case spv::OpDecorate:
        return !removed_.contains(instruction.words[1]);
      default:
        return instruction.result == 0 || !removed_.contains(instruction.result);
    }
  }

  std::string place_of(const Instruction& instruction, std::string_view label) const {
    const std::string file = string_of(module_, instruction.line.file);
    if (instruction.line.line == 0) return std::string(label);
    return fmt::format("{}:{}", file.empty() ? std::string(label) : shortened(file), instruction.line.line);
  }

 private:
  Module module_;
  std::unordered_set<std::uint32_t> sets_, removed_;
  bool keeps_extension_ = false;
};

/// The format and the arguments of a call.
PrintCall read_call(const Module& module, const Instruction& instruction, std::string place) {
  PrintCall call{.place = std::move(place),
                 .source = string_of(module, instruction.words[format_word]),
                 .format = {},
                 .arguments = {},
                 .slot_words = words_before_arguments};
  try {
    for (std::size_t i = format_word + 1; i < instruction.words.size(); ++i) {
      const Instruction& argument = definition(module, instruction.words[i]);
      const spv::Op type = argument.type == 0 ? spv::OpNop : definition(module, argument.type).op;
      if (type != spv::OpTypeInt && type != spv::OpTypeFloat && type != spv::OpTypeBool && type != spv::OpTypeVector)
        throw Error(fmt::format("argument {} is neither a scalar nor a vector", i - format_word));
      call.arguments.push_back(components_of(module, argument.type).value());
      call.slot_words += word_count(call.arguments.back());
    }
    call.format = parse_print_format(call.source);
    check_arguments(call.format, call.arguments);
  } catch (const Error& error) {
    throw rhi::Error(rhi::ErrorCode::invalid_argument, call.place,
                     fmt::format("debugPrintfEXT(\"{}\"): {}", shortened(call.source), error.what()));
  }
  return call;
}

/// Writes the code in a call's place.
class PrintCode {
 public:
  PrintCode(const Module& module, const PrintPlace& place) : module_(module), globals_(module), code_(globals_) {
    const auto find = [&](spv::Op op) { return std::ranges::find(module.instructions, op, &Instruction::op)->words; };
    const bool is_compute = find(spv::OpEntryPoint)[1] == spv::ExecutionModelGLCompute;
    id_ =
        globals_.input(is_compute ? spv::BuiltInGlobalInvocationId : spv::BuiltInLaunchIdKHR, globals_.uint_vector(3));
    buffer_ = globals_.word_buffer(place.set, place.binding);
    word_pointer_ = globals_.pointer_type(globals_.buffer_storage(), globals_.uint_type());
    // Of the scopes that are wide enough, the one that needs no capability.
    const bool is_vulkan_model = find(spv::OpMemoryModel)[2] == spv::MemoryModelVulkan;
    scope_ = globals_.constant(is_vulkan_model ? spv::ScopeQueueFamily : spv::ScopeDevice);
  }

  void append(Words words) { code_.append(std::move(words)); }
  const Globals& globals() const noexcept { return globals_; }
  const std::vector<Words>& instructions() const noexcept { return code_.instructions(); }

  void print(const Instruction& instruction, const PrintCall& call, std::uint32_t number) {
    const std::uint32_t uint = globals_.uint_type(), boolean = globals_.bool_type();
    const auto header = [&](std::uint32_t word) { return word_pointer(globals_.constant(word)); };
    const std::uint32_t zero = globals_.constant(0), one = globals_.constant(1);
    const std::uint32_t count = header(print_header_count);
    const std::uint32_t before = code_.value(spv::OpAtomicLoad, uint, {count, scope_, zero});
    const std::uint32_t counts = code_.value(spv::OpULessThan, boolean, {before, globals_.constant(most_calls)});
    const std::uint32_t index = code_.value(
        spv::OpAtomicIAdd, uint, {count, scope_, zero, code_.value(spv::OpSelect, uint, {counts, one, zero})});
    const std::uint32_t capacity = code_.load(header(print_header_capacity), uint);
    const std::uint32_t fits = code_.value(spv::OpULessThan, boolean, {index, capacity});
    const std::uint32_t slot = code_.value(spv::OpSelect, uint, {fits, index, capacity});
    const std::uint32_t words = code_.load(header(print_header_slot_words), uint);
    const std::uint32_t offset = code_.value(spv::OpIMul, uint, {slot, words});
    next_ = code_.value(spv::OpIAdd, uint, {offset, globals_.constant(print_header_words)});
    store(globals_.constant(number + 1));
    store_invocation();
    for (std::size_t i = 0; i < call.arguments.size(); ++i)
      for (const Component& component : call.arguments[i])
        store_component(instruction.words[format_word + 1 + i], component);
  }

 private:
  std::uint32_t word_pointer(std::uint32_t index) {
    return code_.value(spv::OpAccessChain, word_pointer_, {buffer_, globals_.constant(0), index});
  }

  /// Into the next word of the slot.
  void store(std::uint32_t word) {
    code_.store(word_pointer(next_), word);
    next_ = code_.value(spv::OpIAdd, globals_.uint_type(), {next_, globals_.constant(1)});
  }

  void store_invocation() {
    const std::uint32_t uint = globals_.uint_type();
    const std::uint32_t component = globals_.input_component(id_);  // may be int: the words are the same
    const std::uint32_t pointer = globals_.pointer_type(spv::StorageClassInput, component);
    for (std::uint32_t axis = 0; axis < 3; ++axis) {
      const std::uint32_t loaded =
          code_.load(code_.value(spv::OpAccessChain, pointer, {id_, globals_.constant(axis)}), component);
      store(component == uint ? loaded : code_.value(spv::OpBitcast, uint, {loaded}));
    }
  }

  void store_component(std::uint32_t argument, const Component& component) {
    std::uint32_t scalar = argument;
    if (!component.path.empty())
      scalar = code_.value(spv::OpCompositeExtract, scalar_type(globals_, component), {argument, component.path[0]});
    std::array<std::uint32_t, 2> words = {};
    append_words(code_, component, scalar, words.data());
    for (std::uint32_t i = 0; i < component.word_count(); ++i) store(words[i]);
  }

  const Module& module_;
  Globals globals_;
  Code code_;
  std::uint32_t id_ = 0, buffer_ = 0, word_pointer_ = 0, scope_ = 0;
  std::uint32_t next_ = 0;  ///< the word to write
};

}  // namespace

bool prints(std::span<const std::uint32_t> spirv) {
  for (std::size_t i = rhi::spirv_header_words; i < spirv.size();) {
    const std::size_t length = spirv[i] >> 16;
    if (length == 0 || length > spirv.size() - i) return false;
    const auto instruction = spirv.subspan(i, length);
    if (rhi::operation_of(instruction) == spv::OpExtInstImport && length > 2 &&
        literal(instruction.subspan(2)) == print_set)
      return true;
    if (rhi::operation_of(instruction) == spv::OpFunction) return false;
    i += length;
  }
  return false;
}

std::vector<std::uint32_t> without_prints(std::span<const std::uint32_t> spirv, std::string_view label) {
  if (!prints(spirv)) return {spirv.begin(), spirv.end()};
  const Rewriter rewriter(spirv, label);
  std::vector<std::uint32_t> result(spirv.begin(), spirv.begin() + rhi::spirv_header_words);
  for (const Instruction& instruction : rewriter.module().instructions)
    if (rewriter.is_kept(instruction)) result.insert(result.end(), instruction.words.begin(), instruction.words.end());
  return result;
}

PrintingShader with_print_buffer(std::span<const std::uint32_t> spirv, std::string_view label,
                                 const PrintPlace& place) {
  const Rewriter rewriter(spirv, label);
  const Module& module = rewriter.module();
  PrintCode code(module, place);
  PrintingShader result;
  for (std::size_t i = module.first_function; i < module.instructions.size(); ++i) {
    const Instruction& instruction = module.instructions[i];
    if (!rewriter.is_call(instruction)) {
      if (rewriter.is_kept(instruction)) code.append(instruction.words);
      continue;
    }
    const auto number = place.first_call + static_cast<std::uint32_t>(result.calls.size());
    result.calls.push_back(read_call(module, instruction, rewriter.place_of(instruction, label)));
    code.print(instruction, result.calls.back(), number);
  }

  std::vector<std::uint32_t>& words = result.spirv;
  words.assign(module.header.begin(), module.header.end());
  const auto append = [&](const Words& each) { words.insert(words.end(), each.begin(), each.end()); };
  const auto append_all = [&](const std::vector<Words>& all) { std::ranges::for_each(all, append); };
  bool has_extensions = false;
  for (std::size_t i = 0; i < module.first_function; ++i) {
    const Instruction& instruction = module.instructions[i];
    if (!has_extensions && instruction.op != spv::OpCapability) {
      append_all(code.globals().extensions());
      has_extensions = true;
    }
    if (i == module.first_global) append_all(code.globals().annotations());
    Words own = instruction.words;
    if (instruction.op == spv::OpEntryPoint) {
      own.insert(own.end(), code.globals().interface().begin(), code.globals().interface().end());
      own[0] = static_cast<std::uint32_t>(own.size() << 16 | spv::OpEntryPoint);
    }
    if (rewriter.is_kept(instruction)) append(own);
  }
  append_all(code.globals().declarations());
  append_all(code.instructions());
  words[3] = code.globals().bound();
  return result;
}

}  // namespace tandem::program
