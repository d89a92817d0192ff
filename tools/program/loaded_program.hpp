#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "program/job/job.hpp"
#include "program/reflect/shader_interface.hpp"
#include "tools/program/run_options.hpp"

/// The shaders of a run, and what they have to be given.
namespace tandem::tools::program_run {

/// A binding that a launch uses.
struct NeededBinding {
  rhi::ShaderBinding binding;                   ///< writable where any shader of the launch writes
  const program::BlockLayout* block = nullptr;  ///< of a buffer; in the interface of a shader
  std::vector<std::string> names;               ///< that a key may have

  /// What a resource for it is called unless the user says otherwise: a name, or "0:1".
  std::string key() const;
  /// "0:1 (Words)"
  std::string text() const;
};

/// A shader of a launch, at its position in Job::shaders.
struct LaunchShader {
  std::size_t index = 0;
  rhi::ShaderStage stage = rhi::ShaderStage::compute;
};

struct LoadedLaunch {
  std::vector<LaunchShader> shaders;
  std::vector<std::vector<LaunchShader>> hit_groups;  ///< those of --hit
  std::vector<NeededBinding> bindings;                ///< sorted by (set, binding)
  std::optional<program::ValueType> push_constants;   ///< the largest block

  bool is_ray_tracing() const { return !shaders.empty() && shaders[0].stage != rhi::ShaderStage::compute; }
};

struct LoadedProgram {
  std::vector<program::Shader> shaders;
  std::vector<program::ShaderInterface> interfaces;  ///< of each shader
  std::vector<LoadedLaunch> launches;
};

/// Loads every shader that the options name, each file once. Throws Error or rhi::Error, naming the file.
LoadedProgram load_program(const RunOptions& options);

/// The element of an array of descriptors that a key "NAME[3]" or "0:1[3]" means, of the binding that it means.
struct KeyMatch {
  std::optional<std::uint32_t> element = {};  ///< nothing: all of them
};
std::optional<KeyMatch> match(std::string_view key, const NeededBinding& binding);

}  // namespace tandem::tools::program_run
