#include <doctest/doctest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "rhi/glsl/compile.hpp"
#include "tests/rhi/dispatch.hpp"

// What is no valid SPIR-V is the same error on every device, and reaches neither parser nor driver.

using namespace tandem;
using namespace tandem::test;

namespace {

using Words = std::vector<std::uint32_t>;

constexpr std::size_t header_words = 5;
constexpr std::uint32_t op_line = 8;
constexpr std::uint32_t op_constant = 43;
constexpr std::uint32_t op_label = 248;
constexpr std::uint32_t op_store = 62;

Words small_module(bool debug_info = false) {
  return glsl::compile(R"(#version 460
layout(binding = 0) buffer B { float b[]; };
void main() { b[0] = 2.0 * b[1]; }
)",
                       rhi::ShaderStage::compute, "small", {.include_directories = {}, .debug_info = debug_info});
}

/// The position of the first instruction of that operation.
std::size_t position_of(std::uint32_t operation, const Words& words) {
  std::size_t i = header_words;
  while (i < words.size() && (words[i] & 0xffff) != operation) i += words[i] >> 16;
  REQUIRE(i < words.size());
  return i;
}

}  // namespace

TANDEM_DEVICE_TEST("SPIR-V that is not valid is refused in the validator's words") {
  const auto create = [&](const Words& words) { device.create_shader_module({.spirv = words, .label = "broken"}); };
  Words words = small_module();
  create(words);
  // An id beyond the bound, of a constant and of a label; a label twice; an operand that nothing defines.
  words[position_of(op_constant, words) + 2] = 655419;
  CHECK_ERROR(invalid_argument, "broken: the SPIR-V is not valid: Result <id> '655419' must be less than the ID bound",
              create(words));
  words = small_module();
  words[position_of(op_label, words) + 1] = 262205;
  CHECK_ERROR(invalid_argument, "broken: the SPIR-V is not valid: Result <id> '262205'", create(words));
  words = small_module();
  words[position_of(op_label, words) + 1] = words[position_of(op_constant, words) + 2];
  CHECK_ERROR(invalid_argument, "is defined more than once", create(words));
  words = small_module();
  words[position_of(op_store, words) + 2] = 33554438;
  CHECK_ERROR(invalid_argument, "has not been defined", create(words));
}

TANDEM_DEVICE_TEST("words that are no instructions, and lines of no file, are refused") {
  const auto create = [&](const Words& words) { device.create_shader_module({.spirv = words, .label = "broken"}); };
  Words words = small_module();
  const std::size_t store = position_of(op_store, words);
  words[store] = op_store;
  CHECK_ERROR(invalid_argument, "broken: the SPIR-V is not valid: the instruction at word", create(words));
  words[store] = 0xffff0000u | op_store;
  CHECK_ERROR(invalid_argument, "has 65535 words", create(words));
  words.resize(header_words - 1);
  CHECK_ERROR(invalid_argument, "broken: the shader is not SPIR-V", create(words));
  words = small_module(true);
  create(words);
  words[position_of(op_line, words) + 1] = 0x7fffffff;
  CHECK_ERROR(invalid_argument, "OpLine names no file", create(words));
}
