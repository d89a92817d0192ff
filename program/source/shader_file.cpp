#include "program/source/shader_file.hpp"

#include <cstring>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <spirv-tools/libspirv.hpp>

#include "base/error.hpp"
#include "base/input_file.hpp"
#include "base/printable.hpp"
#include "base/text_file.hpp"
#include "rhi/entry_point.hpp"
#include "rhi/error.hpp"
#include "rhi/spirv_validation.hpp"

namespace tandem::program {
namespace {

constexpr std::uint64_t most_bytes = std::uint64_t{1} << 28;

std::vector<std::uint32_t> read_words(const std::filesystem::path& path) {
  const std::string bytes = read_bytes(path, most_bytes);
  if (bytes.size() % 4 != 0 || bytes.empty())
    throw Error(fmt::format("cannot read '{}': it has {} bytes, which are no words of SPIR-V", shortened(path.string()),
                            bytes.size()));
  std::vector<std::uint32_t> words(bytes.size() / 4);
  std::memcpy(words.data(), bytes.data(), bytes.size());
  return words;
}

/// What a line such as "; Version: 1.3" says.
spv_target_env version_of(const std::string& text) {
  constexpr std::pair<const char*, spv_target_env> versions[] = {
      {"1.0", SPV_ENV_UNIVERSAL_1_0}, {"1.1", SPV_ENV_UNIVERSAL_1_1}, {"1.2", SPV_ENV_UNIVERSAL_1_2},
      {"1.3", SPV_ENV_UNIVERSAL_1_3}, {"1.4", SPV_ENV_UNIVERSAL_1_4}, {"1.6", SPV_ENV_UNIVERSAL_1_6}};
  for (const auto& [version, environment] : versions)
    if (text.find(std::string("; Version: ") + version) != std::string::npos) return environment;
  return SPV_ENV_UNIVERSAL_1_5;
}

std::vector<std::uint32_t> assemble(const std::filesystem::path& path) {
  const std::string text = read_text(path);
  std::string reason;
  spvtools::SpirvTools assembler(version_of(text));
  assembler.SetMessageConsumer(
      [&](spv_message_level_t, const char*, const spv_position_t& position, const char* message) {
        if (reason.empty()) reason = fmt::format("line {}: {}", position.line + 1, message);
      });
  std::vector<std::uint32_t> words;
  if (!assembler.Assemble(text, &words))
    throw rhi::Error(rhi::ErrorCode::shader_compilation, path.string(),
                     reason.empty() ? "SPIRV-Tools cannot assemble it" : reason);
  return words;
}

/// A module of SPIR-V says itself what stage it is.
Shader module_of(const std::filesystem::path& path, std::vector<std::uint32_t> words, const std::string& entry_point) {
  const std::string name = path.string();
  rhi::check_spirv(words, name);
  const rhi::ShaderReflection reflection =
      rhi::reflect_valid(rhi::with_one_entry_point(words, entry_point, name), name);
  return {.name = name, .stage = reflection.stage, .spirv = std::move(words), .entry_point = entry_point};
}

}  // namespace

Shader load_shader(const std::filesystem::path& path, const glsl::CompileOptions& options,
                   const std::string& entry_point) {
  if (const std::optional<rhi::ShaderStage> stage = glsl::stage_of(path))
    return {.name = path.string(), .stage = *stage, .spirv = glsl::compile_file(path, options)};
  const std::string extension = path.extension().string();
  if (extension == ".spv") return module_of(path, read_words(path), entry_point);
  if (extension == ".spvasm") return module_of(path, assemble(path), entry_point);
  throw Error(
      fmt::format("'{}' is no shader: GLSL ends in .comp, .rgen, .rmiss, .rchit, .rahit, .rint or .rcall, "
                  "SPIR-V in .spv or .spvasm",
                  shortened(path.string())));
}

}  // namespace tandem::program
