#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include <spirv-tools/libspirv.hpp>

namespace tandem::test {

/// SPIR-V from assembly, for what GLSL has no way to say. Throws std::runtime_error with the assembler's sentence.
inline std::vector<std::uint32_t> assembled(const std::string& text, spv_target_env environment = SPV_ENV_VULKAN_1_2) {
  spvtools::SpirvTools tools(environment);
  std::string message;
  tools.SetMessageConsumer([&](spv_message_level_t, const char*, const spv_position_t& place, const char* sentence) {
    message = std::to_string(place.line + 1) + ": " + sentence;
  });
  std::vector<std::uint32_t> words;
  if (!tools.Assemble(text, &words)) throw std::runtime_error(message);
  return words;
}

}  // namespace tandem::test
