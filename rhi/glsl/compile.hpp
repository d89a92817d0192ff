#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "rhi/shader_reflection.hpp"

/// GLSL to SPIR-V at run time, by glslang: for shaders that a user or a test brings.
namespace tandem::glsl {

struct CompileOptions {
  std::vector<std::filesystem::path>
      include_directories;  ///< searched for #include "..." after the source's own folder
  bool debug_info = false;  ///< keep names and line numbers, so that the CPU device can point a debugger at the GLSL
};

/// SPIR-V 1.5 for Vulkan 1.2. `name` stands for the source in messages. Throws rhi::Error(shader_compilation) with
/// glslang's own first message.
std::vector<std::uint32_t> compile(std::string_view source, rhi::ShaderStage stage, const std::string& name,
                                   const CompileOptions& options = {});

}  // namespace tandem::glsl
