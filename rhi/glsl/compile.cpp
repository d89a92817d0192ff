#include "rhi/glsl/compile.hpp"

#include <fstream>
#include <iterator>
#include <memory>
#include <mutex>
#include <sstream>

#include <glslang/Public/ResourceLimits.h>
#include <glslang/Public/ShaderLang.h>
#include <glslang/SPIRV/GlslangToSpv.h>

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

/// Resolves #include "file" against the including file's folder, then the folders of the options.
class FileIncluder : public glslang::TShader::Includer {
 public:
  explicit FileIncluder(const CompileOptions& options) : options_(options) {}

  IncludeResult* includeLocal(const char* header, const char* includer, size_t /*depth*/) override {
    std::vector<std::filesystem::path> folders = {std::filesystem::path(includer).parent_path()};
    folders.insert(folders.end(), options_.include_directories.begin(), options_.include_directories.end());
    for (const std::filesystem::path& folder : folders) {
      const std::filesystem::path path = folder / header;
      std::ifstream file(path, std::ios::binary);
      if (!file) continue;
      auto included = std::make_unique<Included>();
      included->text.assign(std::istreambuf_iterator<char>(file), {});
      included->result =
          std::make_unique<IncludeResult>(path.string(), included->text.data(), included->text.size(), nullptr);
      included_.push_back(std::move(included));
      return included_.back()->result.get();
    }
    return nullptr;
  }

  IncludeResult* includeSystem(const char*, const char*, size_t) override { return nullptr; }
  void releaseInclude(IncludeResult*) override {}  // they live as long as the includer

 private:
  struct Included {
    std::string text;
    std::unique_ptr<IncludeResult> result;
  };

  const CompileOptions& options_;
  std::vector<std::unique_ptr<Included>> included_;
};

std::string first_error(const std::string& log) {
  std::istringstream lines(log);
  for (std::string line; std::getline(lines, line);)
    if (line.starts_with("ERROR:")) return line.substr(line.find_first_not_of(' ', 6));
  return log;
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
  shader.setEnvClient(glslang::EShClientVulkan, glslang::EShTargetVulkan_1_2);
  shader.setEnvTarget(glslang::EShTargetSpv, glslang::EShTargetSpv_1_5);

  const auto rules = static_cast<EShMessages>(EShMsgSpvRules | EShMsgVulkanRules |
                                              (options.debug_info ? EShMsgDebugInfo : EShMsgDefault));
  constexpr int default_version = 460;
  FileIncluder includer(options);
  if (!shader.parse(GetDefaultResources(), default_version, false, rules, includer)) fail(name, shader.getInfoLog());
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

}  // namespace tandem::glsl
