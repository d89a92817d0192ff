#include "rhi/glsl/compile.hpp"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <mutex>
#include <sstream>
#include <utility>

#include <glslang/Public/ResourceLimits.h>
#include <glslang/Public/ShaderLang.h>
#include <glslang/SPIRV/GlslangToSpv.h>

#include "base/error.hpp"
#include "base/input_file.hpp"
#include "rhi/error.hpp"

namespace tandem::glsl {
namespace {

/// glslang wants one initialisation per process that uses it.
class GlslangProcess {
 public:
  GlslangProcess() { glslang::InitializeProcess(); }
  ~GlslangProcess() { glslang::FinalizeProcess(); }
  GlslangProcess(const GlslangProcess&) = delete;
  GlslangProcess& operator=(const GlslangProcess&) = delete;
};

EShLanguage language_of(rhi::ShaderStage stage) {
  switch (stage) {
    case rhi::ShaderStage::compute:
      return EShLangCompute;
    case rhi::ShaderStage::ray_generation:
      return EShLangRayGen;
    case rhi::ShaderStage::any_hit:
      return EShLangAnyHit;
    case rhi::ShaderStage::closest_hit:
      return EShLangClosestHit;
    case rhi::ShaderStage::miss:
      return EShLangMiss;
    case rhi::ShaderStage::intersection:
      return EShLangIntersect;
    case rhi::ShaderStage::callable:
      return EShLangCallable;
  }
  return EShLangCompute;
}

/// Files in files: a file that includes itself without a guard has no end.
constexpr std::size_t deepest_include = 64;
/// Files, and bytes of them, that a shader is made of: each may include two others, each of which two more.
constexpr std::size_t most_includes = 10000;
constexpr std::size_t most_included_bytes = std::size_t{64} << 20;

/// Resolves #include "file" against the including file's folder, then the folders of the options.
class FileIncluder : public glslang::TShader::Includer {
 public:
  explicit FileIncluder(const CompileOptions& options) : options_(options) {}

  IncludeResult* includeLocal(const char* header, const char* includer, size_t depth) override {
    if (!refusal_.empty()) return nullptr;
    std::vector<std::filesystem::path> folders = {std::filesystem::path(includer).parent_path()};
    folders.insert(folders.end(), options_.include_directories.begin(), options_.include_directories.end());
    if (IncludeResult* const given = include_given(folders.front() / header, header, depth)) return given;
    if (!refusal_.empty()) return nullptr;
    for (const std::filesystem::path& folder : folders) {
      const std::filesystem::path path = folder / header;
      std::error_code status_error;
      if (!std::filesystem::exists(path, status_error)) continue;
      if (depth > deepest_include) return refuse_depth(path.string());
      try {
        return include(path.string(), read_bytes(path, most_included_bytes));
      } catch (const tandem::Error& error) {
        return refuse(error.what());
      }
    }
    return nullptr;
  }

  IncludeResult* includeSystem(const char*, const char*, size_t) override { return nullptr; }
  void releaseInclude(IncludeResult*) override {}  // they live as long as the includer

  /// Why a file that is there was not included; "" when none was refused.
  const std::string& refusal() const { return refusal_; }

 private:
  struct Included {
    std::string text;
    std::unique_ptr<IncludeResult> result;
  };

  /// One of the options' files; null when there is none of the name.
  IncludeResult* include_given(const std::filesystem::path& beside, const char* header, size_t depth) {
    for (const SourceFile& file : options_.files) {
      if (file.path != header && std::filesystem::path(file.path).lexically_normal() != beside.lexically_normal())
        continue;
      if (depth > deepest_include) return refuse_depth(file.path);
      return include(file.path, file.text);
    }
    return nullptr;
  }

  IncludeResult* include(const std::string& path, std::string text) {
    bytes_ += text.size();
    if (included_.size() >= most_includes || bytes_ > most_included_bytes)
      return refuse(std::to_string(most_includes).append(" files or ") + std::to_string(most_included_bytes >> 20) +
                    " MiB of them are the most that a shader may include");
    auto included = std::make_unique<Included>();
    included->text = std::move(text);
    included->result = std::make_unique<IncludeResult>(path, included->text.data(), included->text.size(), nullptr);
    included_.push_back(std::move(included));
    return included_.back()->result.get();
  }

  IncludeResult* refuse_depth(const std::string& path) {
    return refuse(path + ": it is included by files in files, more than " + std::to_string(deepest_include) +
                  " deep; it may include itself");
  }

  /// The compiler's own sentence would be that the file is not there.
  IncludeResult* refuse(std::string why) {
    refusal_ = std::move(why);
    return nullptr;
  }

  const CompileOptions& options_;
  std::vector<std::unique_ptr<Included>> included_;
  std::size_t bytes_ = 0;
  std::string refusal_;
};

std::string first_error(const std::string& log) {
  std::istringstream lines(log);
  for (std::string line; std::getline(lines, line);)
    if (line.starts_with("ERROR:")) return line.substr(line.find_first_not_of(' ', 6));
  return log;
}

bool is_identifier(std::string_view name) {
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; };
  const auto is_part = [&](char c) { return is_letter(c) || (c >= '0' && c <= '9'); };
  return !name.empty() && is_letter(name.front()) && std::all_of(name.begin(), name.end(), is_part);
}

/// What stands between the #version line and the rest of the source.
std::string preamble(const CompileOptions& options, const std::string& name) {
  std::string text = "#extension GL_GOOGLE_include_directive : enable\n";
  for (const Define& define : options.defines) {
    if (!is_identifier(define.name) || define.value.find('\n') != std::string::npos)
      throw rhi::Error(rhi::ErrorCode::invalid_argument, name,
                       "'" + define.name + "' cannot be defined: a macro has an identifier and one line");
    text += "#define " + define.name + " " + define.value + "\n";
  }
  return text;
}

struct Target {
  glslang::EShTargetClientVersion vulkan;
  glslang::EShTargetLanguageVersion spirv;
};

Target target_of(SpirvVersion version) {
  switch (version) {
    case SpirvVersion::v1_0:
      return {glslang::EShTargetVulkan_1_0, glslang::EShTargetSpv_1_0};
    case SpirvVersion::v1_3:
      return {glslang::EShTargetVulkan_1_1, glslang::EShTargetSpv_1_3};
    case SpirvVersion::v1_4:
      return {glslang::EShTargetVulkan_1_2, glslang::EShTargetSpv_1_4};
    case SpirvVersion::v1_5:
      return {glslang::EShTargetVulkan_1_2, glslang::EShTargetSpv_1_5};
    case SpirvVersion::v1_6:
      return {glslang::EShTargetVulkan_1_3, glslang::EShTargetSpv_1_6};
  }
  return {glslang::EShTargetVulkan_1_2, glslang::EShTargetSpv_1_5};
}

[[noreturn]] void fail(const std::string& name, const std::string& log) {
  throw rhi::Error(rhi::ErrorCode::shader_compilation, name, "the GLSL does not compile: " + first_error(log));
}

}  // namespace

std::vector<std::uint32_t> compile(std::string_view source, rhi::ShaderStage stage, const std::string& name,
                                   const CompileOptions& options) {
  static const GlslangProcess process;

  const EShLanguage language = language_of(stage);
  glslang::TShader shader(language);
  const char* text = source.data();
  const int length = static_cast<int>(source.size());
  const char* text_name = name.c_str();
  shader.setStringsWithLengthsAndNames(&text, &length, &text_name, 1);
  shader.setEnvInput(glslang::EShSourceGlsl, language, glslang::EShClientVulkan, 100);
  const Target target = target_of(options.spirv);
  shader.setEnvClient(glslang::EShClientVulkan, target.vulkan);
  shader.setEnvTarget(glslang::EShTargetSpv, target.spirv);
  const std::string text_before = preamble(options, name);
  shader.setPreamble(text_before.c_str());

  const auto rules = static_cast<EShMessages>(EShMsgSpvRules | EShMsgVulkanRules |
                                              (options.debug_info ? EShMsgDebugInfo : EShMsgDefault));
  constexpr int default_version = 460;
  FileIncluder includer(options);
  const bool parsed = shader.parse(GetDefaultResources(), default_version, false, rules, includer);
  if (!includer.refusal().empty()) fail(name, includer.refusal());
  if (!parsed) fail(name, shader.getInfoLog());
  glslang::TProgram program;
  program.addShader(&shader);
  if (!program.link(rules)) fail(name, program.getInfoLog());

  glslang::SpvOptions spirv_options;
  spirv_options.generateDebugInfo = options.debug_info;
  spirv_options.disableOptimizer = true;
  std::vector<unsigned int> words;
  glslang::GlslangToSpv(*program.getIntermediate(language), words, &spirv_options);
  return words;
}

std::optional<rhi::ShaderStage> stage_of(const std::filesystem::path& file) {
  const std::filesystem::path name = file.extension() == ".glsl" ? file.stem() : file.filename();
  const std::string extension = name.extension().string();
  if (extension == ".comp") return rhi::ShaderStage::compute;
  if (extension == ".rgen") return rhi::ShaderStage::ray_generation;
  if (extension == ".rahit") return rhi::ShaderStage::any_hit;
  if (extension == ".rchit") return rhi::ShaderStage::closest_hit;
  if (extension == ".rmiss") return rhi::ShaderStage::miss;
  if (extension == ".rint") return rhi::ShaderStage::intersection;
  if (extension == ".rcall") return rhi::ShaderStage::callable;
  return std::nullopt;
}

std::vector<std::uint32_t> compile_file(const std::filesystem::path& file, const CompileOptions& options) {
  const std::optional<rhi::ShaderStage> stage = stage_of(file);
  if (!stage)
    throw rhi::Error(rhi::ErrorCode::invalid_argument, file.string(),
                     "the extension names no stage: .comp, .rgen, .rahit, .rchit, .rmiss, .rint or .rcall");
  return compile(read_bytes(file, most_included_bytes), *stage, file.string(), options);
}

}  // namespace tandem::glsl
