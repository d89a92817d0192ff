#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "program/amber/expectation.hpp"
#include "program/amber/position.hpp"
#include "program/amber/requirement.hpp"
#include "program/job/job.hpp"

/// Scripts of Amber, the shader test language of google/amber: shaders, resources, commands and what is expected of the
/// results, in one text file.
namespace tandem::program::amber {

enum class Language : std::uint8_t { glsl, spirv_assembly, spirv };

/// What a shader of the job is compiled from.
struct ShaderSource {
  Language language = Language::glsl;
  std::string text;        ///< of SPIR-V the words' bytes
  std::string target_env;  ///< "spv1.4", "vulkan1.2"
  std::string path = {};   ///< of the file that it is from, to which #include is relative; "" for one in the script
  std::vector<std::string> optimizations = {};  ///< SPIRV-Tools passes, such as "--merge-return"
  Position position;                            ///< of the declaration
  Position text_position;                       ///< of the text, where it is in the script
};

/// A file that shaders can include.
struct VirtualFile {
  std::string path;
  std::string text;
};

/// One thing to do.
struct Step {
  enum class Kind : std::uint8_t { command, expectation };

  Kind kind = Kind::command;
  std::size_t index = 0;  ///< in Job::commands or Script::expectations
};

/// A compute pipeline that requires the device's smallest or largest subgroup size.
struct ExtremeSubgroupSize {
  std::size_t pipeline = 0;
  bool largest = false;
};

/// A script, parsed. REPEAT is written out: `steps` has every command and expectation in the order in which they take
/// place, and Job::commands the commands alone.
struct Script {
  std::filesystem::path file;         ///< names the script in messages; files that it refers to lie beside it
  Job job;                            ///< its shaders' SPIR-V is empty before compile()
  std::vector<ShaderSource> sources;  ///< of the job's shaders, in their order
  std::vector<VirtualFile> virtual_files;
  std::vector<Requirement> requirements;
  std::vector<ExtremeSubgroupSize> extreme_subgroup_sizes;
  std::vector<Expectation> expectations;
  std::vector<Step> steps;
  /// Why no device of ours runs it: what it uses of graphics or of other languages, with its line. "": it runs.
  std::string unsupported;
};

/// Parses the text. Throws ScriptError with the place of what is wrong, and Error for a file that the script refers to
/// and that cannot be read.
Script parse(std::string_view text, const std::filesystem::path& file);

/// Reads and parses a file.
Script read(const std::filesystem::path& file);

/// Compiles the shaders into the job. Throws ScriptError with the place of the shader's declaration.
/// @param debug_info GLSL keeps names and line numbers, which are the script's
void compile(Script& script, bool debug_info = false);

}  // namespace tandem::program::amber
