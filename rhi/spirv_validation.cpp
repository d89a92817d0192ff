#include "rhi/spirv_validation.hpp"

#include <string>
#include <unordered_set>
#include <vector>

#include <spirv-tools/libspirv.hpp>

#include "rhi/error.hpp"
#include "rhi/spirv/words.hpp"

namespace tandem::rhi {
namespace {

void require(bool holds, std::string_view label, const std::string& otherwise) {
  if (!holds) throw Error(ErrorCode::invalid_argument, label, otherwise);
}

/// The module without OpLine and OpNoLine, whose own rule is checked here: the validator takes time that grows with the
/// square of their number (eight times as long for the path tracer).
std::vector<std::uint32_t> without_lines(std::span<const std::uint32_t> words, std::string_view label) {
  std::vector<std::uint32_t> result(words.begin(), words.begin() + spirv_header_words);
  result.reserve(words.size());
  std::unordered_set<std::uint32_t> strings;
  for_each_instruction(words, [&](std::span<const std::uint32_t> i) {
    if (operation_of(i) == spv::OpLine) {
      require(i.size() == 4 && strings.contains(i[1]), label, "the SPIR-V is not valid: OpLine names no file");
      return;
    }
    if (operation_of(i) == spv::OpNoLine && i.size() == 1) return;
    if (operation_of(i) == spv::OpString && i.size() > 2) strings.insert(i[1]);
    result.insert(result.end(), i.begin(), i.end());
  });
  return result;
}

/// The first line of the validator's message, without what a module's own names could put on a terminal.
std::string sentence(std::string_view message) {
  constexpr std::size_t longest = 300;
  std::string text(message.substr(0, message.find('\n')));
  if (text.size() > longest) text = text.substr(0, longest) + "...";
  for (char& c : text)
    if (c < ' ' || c > '~') c = '?';
  return text;
}

}  // namespace

void check_spirv_words(std::span<const std::uint32_t> words, std::string_view label) {
  require(words.size() >= spirv_header_words && words[0] == spv::MagicNumber, label,
          "the shader is not SPIR-V: its first word is not the magic number");
  for (std::size_t i = spirv_header_words; i < words.size();) {
    const std::size_t length = words[i] >> 16;
    require(length > 0 && length <= words.size() - i, label,
            "the SPIR-V is not valid: the instruction at word " + std::to_string(i) + " has " + std::to_string(length) +
                " words, where the module has " + std::to_string(words.size() - i) + " more");
    i += length;
  }
}

void check_spirv(std::span<const std::uint32_t> words, std::string_view label) {
  check_spirv_words(words, label);
  const std::vector<std::uint32_t> module = without_lines(words, label);
  spvtools::SpirvTools tools(SPV_ENV_VULKAN_1_3);
  std::string first_message;
  tools.SetMessageConsumer([&](spv_message_level_t, const char*, const spv_position_t&, const char* message) {
    if (first_message.empty()) first_message = message;
  });
  spvtools::ValidatorOptions options;
  options.SetScalarBlockLayout(true);
  options.SetWorkgroupScalarBlockLayout(true);
  options.SetAllowLocalSizeId(true);
  // glslang passes elements of arrays to functions, such as ray queries, which the rules of logical addressing forbid.
  options.SetBeforeHlslLegalization(true);
  const bool is_valid = tools.Validate(module.data(), module.size(), options);
  require(is_valid, label, "the SPIR-V is not valid: " + sentence(first_message));
}

}  // namespace tandem::rhi
