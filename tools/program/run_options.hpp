#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "program/compare/comparison.hpp"
#include "rhi/glsl/compile.hpp"

/// What `tandem run` is asked for, as texts: by its options or by a job file.
namespace tandem::tools::program_run {

/// KEY=VALUE.
struct Setting {
  std::string where;  ///< in front of what is said of it: "--buffer", "job.json: buffers.data"
  std::string key;
  std::string value;
  std::filesystem::path folder = {};  ///< that files are relative to; empty: the working directory
};

/// One dispatch, or one trace of rays.
struct Launch {
  std::vector<std::filesystem::path> shaders;
  std::string entry_point;                ///< of modules that have several
  std::vector<Setting> hit_groups;        ///< the value: files of one group, separated by commas
  std::vector<Setting> specialization;    ///< by id or name
  std::vector<Setting> push;              ///< without a key: all values in their order
  std::vector<Setting> records;           ///< "hit:0": the shaderRecordEXT block
  std::vector<Setting> bind;              ///< a binding, and the key of the resource, where they are not the same
  std::optional<Setting> groups;          ///< workgroups
  std::optional<Setting> size;            ///< invocations
  std::uint32_t max_recursion_depth = 2;  ///< of rays, where hit or miss shaders trace
};

struct RunOptions {
  std::vector<Launch> launches;
  std::vector<Setting> buffers, images, samplers;
  std::vector<Setting> scenes;  ///< without a key: of every acceleration structure
  bool is_opaque = true;        ///< geometry, where no any-hit shader is given
  std::vector<glsl::Define> defines;
  std::vector<std::filesystem::path> include_directories;
  std::vector<Setting> saves;  ///< a resource, and the file
  bool debug_info = false;     ///< GLSL is compiled with names and line numbers

  std::vector<std::string> devices = {"cpu"};
  bool compare = false;
  program::Tolerance tolerance;
  bool print = false;
  std::uint32_t lines = 16;          ///< of each resource that is printed
  std::uint32_t print_lines = 1000;  ///< of debugPrintfEXT, of each launch; 0: shaders do not print
  bool list = false;
  bool check = false;
  std::uint32_t time = 0;  ///< runs that are measured
  std::uint32_t threads = 0;
  bool validation = false;
};

}  // namespace tandem::tools::program_run
