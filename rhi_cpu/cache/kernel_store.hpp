#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "rhi/compute_pipeline.hpp"
#include "rhi/message.hpp"
#include "rhi_cpu/cache/kernel_cache.hpp"
#include "rhi_cpu/cache/kernel_compiler.hpp"
#include "rhi_cpu/cache/kernel_library.hpp"
#include "rhi_cpu/cache/precompiled_kernel.hpp"
#include "rhi_cpu/kernel/group_limits.hpp"

namespace tandem::cpu {

/// How kernels are translated that are compiled at run time (TranslateOptions).
struct KernelOptions {
  bool robust = false;
  bool watched = false;
  std::uint32_t subgroup_size = kernel::default_subgroup_size;
  std::uint32_t lanes = 0;  ///< DeviceDesc::lanes; of one kernel: TranslateOptions::lanes
  bool quick = false;       ///< DeviceDesc::quick_kernels; of one kernel: it is not optimised
};

/// Native code that runs a shader.
struct Kernel {
  const kernel::KernelInfo* info = nullptr;
  KernelLibraryHandle library;  ///< keeps the code loaded; nothing for a kernel that is a part of the program
};

/// Where native code comes from: the kernels built into the program, else those loaded already, else the cache on
/// disk, else the translator and the system's compiler. Thread-safe; a shader that several threads ask for at once is
/// compiled once.
class KernelStore {
 public:
  /// Precompiled kernels are used where they are: their shaders are known to stay inside of what is bound. None of them
  /// is watched, and their subgroups have the usual size.
  KernelStore(std::vector<PrecompiledKernel> precompiled, const KernelOptions& options,
              std::filesystem::path cache_folder, rhi::MessageCallback on_message);

  /// Throws Error(unsupported) for SPIR-V that cannot be translated, Error(shader_compilation) when there is no
  /// compiler or it fails, Error(io) when the cache fails.
  /// @param values specialisation; constants that are not named have their defaults
  /// @param subgroup_size that the pipeline asks for; 0: that of the options
  Kernel kernel(const rhi::ShaderModule& shader, std::span<const rhi::SpecializationValue> values,
                const std::string& label, std::uint32_t subgroup_size = 0);

 private:
  /// What is known of one key. `mutex` is held while its library is made.
  struct Entry {
    std::mutex mutex;
    std::weak_ptr<const KernelLibrary> library;
  };

  const KernelCompiler& compiler(const std::string& label);
  KernelCache& cache();
  /// The folder of precompiled headers for kernels of a form; "" where kernels are compiled without. Made for the
  /// second kernel of a cache: it takes twice as long as one kernel, and saves two thirds of each that follows.
  std::filesystem::path headers(std::uint32_t lanes, const std::string& label);
  std::shared_ptr<Entry> entry(const ContentHash& key);
  KernelLibraryHandle compile(const rhi::ShaderModule& shader, std::span<const rhi::SpecializationValue> values,
                              const KernelOptions& options, const ContentHash& key, const std::string& label);

  std::vector<PrecompiledKernel> precompiled_;
  KernelOptions options_;
  std::filesystem::path cache_folder_;
  rhi::MessageCallback on_message_;
  std::mutex mutex_;  ///< of what follows
  std::optional<KernelCompiler> compiler_;
  std::optional<KernelCache> cache_;  ///< opened when the first shader needs it
  std::map<ContentHash, std::shared_ptr<Entry>> entries_;
  std::mutex headers_mutex_;  ///< held while the headers are precompiled
};

}  // namespace tandem::cpu
