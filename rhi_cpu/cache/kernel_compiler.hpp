#pragma once

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

/// The processor's name for people, "" when the system does not say.
std::string processor_name();

/// All options of a run-time compilation, the same for every shader. A part of the cache key.
std::string kernel_compile_options();

/// Compiles `folder`/kernel.cpp to `folder`/kernel.so, with the kernel headers written below `folder`. When the
/// compiler fails, its messages are in `folder`/compiler.log.
/// @param debug_info for a source that points a debugger at the shader's own lines
/// @return "" or the first error that the compiler reports
std::string compile_kernel(const KernelCompiler& compiler, const std::filesystem::path& folder,
                           bool debug_info = false);

}  // namespace tandem::cpu
