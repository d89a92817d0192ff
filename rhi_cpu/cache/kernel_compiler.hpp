#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace tandem::cpu {

/// The system's C++ compiler, which turns a translated shader into native code at run time.
struct KernelCompiler {
  std::filesystem::path path;
  std::string version;  ///< what it prints for --version
};

/// $TANDEM_CXX, a path or a name on $PATH; else the first of c++, g++, clang++ on $PATH. Throws
/// Error(shader_compilation) with a sentence that says what to install or set when there is none that runs.
/// @param label the shader that needs it
KernelCompiler find_kernel_compiler(const std::string& label);

/// The processor's model and features, which the code made for it depends on.
std::string processor_identity();

/// How many lanes of a kernel are the fastest on this processor: 4 or 8.
std::uint32_t native_lanes();

/// The processor's name for people, "" when the system does not say.
std::string processor_name();

/// All options of a run-time compilation of optimised kernels. A part of the cache key.
std::string kernel_compile_options();

struct KernelBuild {
  bool debug_info = false;  ///< for a source that points a debugger at the shader's own lines
  bool optimize = true;
};

/// Compiles `folder`/kernel.cpp to `folder`/kernel.so. When the compiler fails, its messages are in
/// `folder`/compiler.log.
/// @param headers a folder of precompile_kernel_headers(); "": the kernel headers are written below `folder`
/// @return "" or the first error that the compiler reports
std::string compile_kernel(const KernelCompiler& compiler, const std::filesystem::path& folder,
                           const std::filesystem::path& headers = {}, const KernelBuild& build = {});

/// Whether the compiler takes a precompiled header that lies beside the header itself, as g++ does.
bool precompiles_headers(const KernelCompiler& compiler);

/// Writes the kernel headers below `folder` and precompiles the one that compile_kernel()'s sources begin with: g++
/// reads them three times as long as it compiles a small kernel. @return whether it could
/// @param lanes TranslateOptions::lanes of the kernels
bool precompile_kernel_headers(const KernelCompiler& compiler, const std::filesystem::path& folder,
                               std::uint32_t lanes = 0);

/// Where precompile_kernel_headers() puts it, below its folder.
std::string precompiled_kernel_header(std::uint32_t lanes = 0);

}  // namespace tandem::cpu
