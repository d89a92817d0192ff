#include "rhi_cpu/cache/kernel_store.hpp"

#include <algorithm>
#include <chrono>
#include <fstream>

#include <fmt/format.h>

#include "rhi/error.hpp"
#include "rhi_cpu/cache/kernel_headers.hpp"
#include "rhi_cpu/translate/supported.hpp"
#include "rhi_cpu/translate/translate.hpp"

namespace tandem::cpu {
namespace {

/// The value of every specialisation constant of the shader, in the order of reflection.
std::vector<rhi::SpecializationValue> complete(const rhi::ShaderReflection& reflection,
                                               std::span<const rhi::SpecializationValue> given) {
  std::vector<rhi::SpecializationValue> values;
  for (const rhi::SpecializationConstant& constant : reflection.specialization_constants) {
    const auto found =
        std::find_if(given.begin(), given.end(), [&](const auto& value) { return value.id == constant.id; });
    values.push_back({.id = constant.id, .value = found == given.end() ? constant.default_value : found->value});
  }
  return values;
}

/// The given values of constants that the shader has. Not `complete`, for two constants may share an id, and then each
/// has a default of its own.
std::vector<rhi::SpecializationValue> declared(const rhi::ShaderReflection& reflection,
                                               std::span<const rhi::SpecializationValue> given) {
  std::vector<rhi::SpecializationValue> values;
  for (const rhi::SpecializationValue& value : given)
    if (std::ranges::find(reflection.specialization_constants, value.id, &rhi::SpecializationConstant::id) !=
        reflection.specialization_constants.end())
      values.push_back(value);
  return values;
}

/// Whether the kernel was made of the shader and the values, which are complete.
bool is_made_of(const PrecompiledKernel& kernel, const rhi::ShaderModule& shader,
                std::span<const rhi::SpecializationValue> values) {
  const std::vector<rhi::SpecializationValue> own = complete(shader.reflection(), kernel.specialization);
  return std::ranges::equal(kernel.spirv, shader.spirv()) &&
         std::ranges::equal(own, values, {}, &rhi::SpecializationValue::value, &rhi::SpecializationValue::value);
}

/// Everything that the native code of a shader depends on.
ContentHash key_of(std::span<const std::uint32_t> spirv, std::span<const rhi::SpecializationValue> values,
                   const KernelOptions& options, const KernelCompiler& compiler) {
  ContentHasher hasher;
  hasher.add(std::uint64_t{kernel::abi_version}).add(std::uint64_t{translator_version});
  hasher.add(std::uint64_t{options.robust}).add(std::uint64_t{options.watched});
  hasher.add(std::uint64_t{options.subgroup_size}).add(std::uint64_t{options.lanes});
  hasher.add(std::uint64_t{options.quick});
  for (const KernelHeader& header : kernel_headers()) hasher.add(header.path).add(header.text);
  hasher.add(compiler.path.string()).add(compiler.version);
  hasher.add(kernel_compile_options()).add(processor_identity());
  hasher.add(std::as_bytes(spirv));
  for (const rhi::SpecializationValue& value : values) hasher.add(std::uint64_t{value.id}).add(value.value);
  return hasher.hash();
}

/// SPIR-V of more words takes the C++ compiler, which makes one function of it, minutes.
constexpr std::size_t most_optimized_words = 1 << 14;

/// TranslateOptions::lanes of a shader.
std::uint32_t lanes_of(const rhi::ShaderModule& shader, bool has_subgroups, const KernelOptions& options) {
  if (shader.reflection().stage != rhi::ShaderStage::compute || options.lanes == 1) return 0;
  if (has_subgroups) return options.subgroup_size >= 4 ? options.subgroup_size : 0;
  if (options.lanes != 0) return options.lanes;
  // Rays of neighbours soon go different ways, and of a workgroup of one invocation no lane but one does anything.
  const auto& size = shader.reflection().workgroup_size;
  if (declares_ray_queries(shader.spirv()) || std::uint64_t{size[0]} * size[1] * size[2] == 1) return 0;
  return native_lanes();
}

}  // namespace

KernelStore::KernelStore(std::vector<PrecompiledKernel> precompiled, const KernelOptions& options,
                         std::filesystem::path cache_folder, rhi::MessageCallback on_message)
    : precompiled_(std::move(precompiled)),
      options_(options),
      cache_folder_(std::move(cache_folder)),
      on_message_(std::move(on_message)) {}

Kernel KernelStore::kernel(const rhi::ShaderModule& shader, std::span<const rhi::SpecializationValue> given,
                           const std::string& label, std::uint32_t subgroup_size) {
  KernelOptions options = options_;
  if (subgroup_size != 0) options.subgroup_size = subgroup_size;
  // So that other shaders have one kernel for all sizes.
  const bool has_subgroups = declares_subgroups(shader.spirv());
  if (!has_subgroups) options.subgroup_size = kernel::default_subgroup_size;
  const std::vector<rhi::SpecializationValue> values = complete(shader.reflection(), given);
  const auto found = std::ranges::find_if(
      precompiled_, [&](const PrecompiledKernel& kernel) { return is_made_of(kernel, shader, values); });
  const bool is_usual = options.subgroup_size == kernel::default_subgroup_size && options.lanes <= 1;
  if (found != precompiled_.end() && !options.watched && is_usual) return {.info = found->entry(), .library = nullptr};
  options.lanes = lanes_of(shader, has_subgroups, options);
  options.quick = options.quick && shader.spirv().size() > most_optimized_words;

  const ContentHash key = key_of(shader.spirv(), values, options, compiler(label));
  const std::shared_ptr<Entry> known = entry(key);
  const std::lock_guard lock(known->mutex);
  KernelLibraryHandle library = known->library.lock();
  if (library == nullptr) library = cache().find(key, label);
  if (library == nullptr) library = compile(shader, declared(shader.reflection(), given), options, key, label);
  known->library = library;
  return {.info = &library->info(), .library = library};
}

KernelLibraryHandle KernelStore::compile(const rhi::ShaderModule& shader,
                                         std::span<const rhi::SpecializationValue> values, const KernelOptions& options,
                                         const ContentHash& key, const std::string& label) {
  const auto start = std::chrono::steady_clock::now();
  TranslateOptions how = {.specialization = values,
                          .robust = options.robust,
                          .watched = options.watched,
                          .subgroup_size = options.subgroup_size,
                          .lanes = options.lanes};
  Translation translation;
  try {
    translation = translate(shader.spirv(), label, how);
  } catch (const rhi::Error& error) {
    // What the wide form does not have.
    if (how.lanes == 0 || error.code() != rhi::ErrorCode::unsupported) throw;
    how.lanes = 0;
    translation = translate(shader.spirv(), label, how);
  }
  KernelCache& store = cache();
  TemporaryFolder folder = store.make_work_folder(label);
  std::ofstream(folder.path() / "kernel.cpp", std::ios::binary) << translation.source;
  // The translator gives line numbers when the SPIR-V has them.
  const bool has_lines = translation.source.find("\n#line ") != std::string::npos;
  const KernelBuild build = {.debug_info = has_lines, .optimize = !options.quick};
  // Headers are precompiled with the options of most kernels.
  const std::filesystem::path precompiled = options.quick ? std::filesystem::path() : headers(how.lanes, label);
  std::string problem = compile_kernel(compiler(label), folder.path(), precompiled, build);
  if (!problem.empty() && !precompiled.empty()) {
    // They may be damaged.
    std::error_code ignored;
    std::filesystem::remove_all(precompiled, ignored);
    problem = compile_kernel(compiler(label), folder.path(), {}, build);
  }
  if (!problem.empty()) {
    const std::filesystem::path kept = store.keep_failure(std::move(folder), key);
    throw rhi::Error(rhi::ErrorCode::shader_compilation, label,
                     fmt::format("the C++ compiler {} failed on the translated shader: {} (see {}/compiler.log and "
                                 "kernel.cpp)",
                                 compiler(label).path.string(), problem, kept.string()));
  }
  KernelLibraryHandle library = store.add(key, folder.path() / "kernel.so", label);
  const std::chrono::duration<double, std::milli> duration = std::chrono::steady_clock::now() - start;
  if (on_message_)
    on_message_({.severity = rhi::Severity::info,
                 .source = "cpu kernel cache",
                 .text = fmt::format("{}: compiled in {:.0f} ms", label, duration.count())});
  return library;
}

std::filesystem::path KernelStore::headers(std::uint32_t lanes, const std::string& label) {
  const KernelCompiler& own_compiler = compiler(label);
  if (!precompiles_headers(own_compiler)) return {};
  const ContentHash key = key_of({}, {}, {.lanes = lanes}, own_compiler);
  KernelCache& store = cache();
  const std::lock_guard lock(headers_mutex_);
  if (std::filesystem::path found = store.find_headers(key, precompiled_kernel_header(lanes)); !found.empty())
    return found;
  if (!store.has_libraries()) return {};
  TemporaryFolder folder = store.make_work_folder(label);
  if (!precompile_kernel_headers(own_compiler, folder.path(), lanes)) return {};
  return store.add_headers(key, std::move(folder));
}

const KernelCompiler& KernelStore::compiler(const std::string& label) {
  const std::lock_guard lock(mutex_);
  if (!compiler_) compiler_ = find_kernel_compiler(label);
  return *compiler_;
}

KernelCache& KernelStore::cache() {
  const std::lock_guard lock(mutex_);
  if (!cache_) cache_.emplace(cache_folder_, on_message_);
  return *cache_;
}

std::shared_ptr<KernelStore::Entry> KernelStore::entry(const ContentHash& key) {
  const std::lock_guard lock(mutex_);
  std::shared_ptr<Entry>& known = entries_[key];
  if (known == nullptr) known = std::make_shared<Entry>();
  return known;
}

}  // namespace tandem::cpu
