#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "rhi/shader_reflection.hpp"

/// GLSL to SPIR-V at run time, by glslang: for shaders that a user or a test brings.
namespace tandem::glsl {

/// A macro: `#define name value` in front of the source.
struct Define {
  std::string name;
  std::string value;
};

/// A file that #include finds without there being one.
struct SourceFile {
  std::string path;  ///< as #include names it, or beside the file that includes it
  std::string text;
};

/// The SPIR-V that glslang writes; each for the oldest Vulkan that takes it.
enum class SpirvVersion { v1_0, v1_3, v1_4, v1_5, v1_6 };

struct CompileOptions {
  std::vector<Define> defines = {};
  SpirvVersion spirv = SpirvVersion::v1_5;
  std::vector<std::filesystem::path> include_directories =
      {};                              ///< searched for #include "..." after the source's own folder
  std::vector<SourceFile> files = {};  ///< looked at before those on disk
  bool debug_info = false;  ///< keep names and line numbers, so that the CPU device can point a debugger at the GLSL
};

/// `name` stands for the source in messages, and #include "..." is looked for beside it first. #include needs no
/// extension in the source. Throws rhi::Error(shader_compilation) with glslang's own first message, or
/// rhi::Error(invalid_argument) for a define whose name is no identifier.
std::vector<std::uint32_t> compile(std::string_view source, rhi::ShaderStage stage, const std::string& name,
                                   const CompileOptions& options = {});

/// The stage that a file's extension names (.comp, .rgen, .rahit, .rchit, .rmiss, .rint, .rcall, also in front of
/// .glsl); empty for any other.
std::optional<rhi::ShaderStage> stage_of(const std::filesystem::path& file);

/// compile() of a file, whose extension names its stage. Throws tandem::Error too, for a file that cannot be read.
std::vector<std::uint32_t> compile_file(const std::filesystem::path& file, const CompileOptions& options = {});

}  // namespace tandem::glsl
