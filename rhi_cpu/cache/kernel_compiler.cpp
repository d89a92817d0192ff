#include "rhi_cpu/cache/kernel_compiler.hpp"

#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <optional>
#include <sstream>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "rhi/error.hpp"
#include "rhi_cpu/cache/kernel_headers.hpp"
#include "rhi_cpu/cache/process.hpp"
#include "rhi_cpu/translate/compile_options.hpp"

namespace tandem::cpu {
namespace {

namespace fs = std::filesystem;

bool is_program(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored) && ::access(path.c_str(), X_OK) == 0;
}

/// The program that a shell would run for `name`, or "".
fs::path find_program(const std::string& name) {
  if (name.find('/') != std::string::npos) return is_program(name) ? fs::absolute(name) : fs::path();
  const char* variable = std::getenv("PATH");
  std::istringstream folders(variable == nullptr ? "/usr/local/bin:/usr/bin:/bin" : variable);
  for (std::string folder; std::getline(folders, folder, ':');) {
    fs::path path = fs::absolute(folder.empty() ? "." : folder) / name;
    if (is_program(path)) return path;
  }
  return {};
}

[[noreturn]] void fail(const std::string& label, const std::string& why) {
  throw rhi::Error(rhi::ErrorCode::shader_compilation, label, why);
}

/// The value of the first line "key : value" of /proc/cpuinfo, "" without one.
std::string processor_property(std::string_view key) {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const std::size_t colon = line.find(':');
    if (colon == std::string::npos || !line.starts_with(key)) continue;
    if (line.find_first_not_of(" \t", key.size()) != colon) continue;
    const std::size_t value = line.find_first_not_of(" \t", colon + 1);
    return value == std::string::npos ? "" : line.substr(value);
  }
  return {};
}

/// Those of every kernel, and the machine's own instructions: kernels compiled at run time never leave it.
std::vector<std::string> options() {
  std::vector<std::string> all = {"-shared", "-fPIC", "-march=native"};
  all.insert(all.end(), std::begin(compile_options), std::end(compile_options));
  return all;
}

std::string first_error_line(const std::string& log) {
  std::istringstream lines(log);
  std::string first;
  for (std::string line; std::getline(lines, line);) {
    if (line.find("error:") != std::string::npos) return line;
    if (first.empty()) first = line;
  }
  return first;
}

/// What the sources of kernels include first.
std::string first_header(std::uint32_t lanes) {
  return lanes == 0 ? "rhi_cpu/kernel/kernel.hpp" : "rhi_cpu/kernel/wide/wide.hpp";
}

void write_kernel_headers(const fs::path& folder) {
  for (const KernelHeader& header : kernel_headers()) {
    const fs::path path = folder / header.path;
    fs::create_directories(path.parent_path());
    std::ofstream(path, std::ios::binary) << header.text;
  }
}

}  // namespace

KernelCompiler find_kernel_compiler(const std::string& label) {
  const char* chosen = std::getenv("TANDEM_CXX");
  const bool is_chosen = chosen != nullptr && *chosen != '\0';
  const std::vector<std::string> names =
      is_chosen ? std::vector<std::string>{chosen} : std::vector<std::string>{"c++", "g++", "clang++"};
  for (const std::string& name : names) {
    const fs::path path = find_program(name);
    if (path.empty()) continue;
    const std::optional<ProcessResult> version = run_process({path.string(), "--version"});
    if (version && version->exit_code == 0) return {.path = path, .version = version->output};
  }
  if (is_chosen)
    fail(label, fmt::format("this shader has no precompiled kernel, and the C++ compiler to make one, TANDEM_CXX={}, "
                            "cannot be run; set TANDEM_CXX to the path of g++ or clang++",
                            chosen));
  fail(label,
       "this shader has no precompiled kernel, and there is no C++ compiler (c++, g++, clang++) on PATH to make one; "
       "install g++ or set TANDEM_CXX to a compiler's path");
}

std::string processor_identity() {
  std::string identity;
  // x86 first, then Arm.
  for (const char* key : {"vendor_id", "cpu family", "model", "model name", "flags", "CPU implementer", "CPU part",
                          "CPU variant", "Features"})
    identity += fmt::format("{}={}\n", key, processor_property(key));
  return identity;
}

std::uint32_t native_lanes() {
  // Not 16 with AVX-512: addresses have 64 bits, and compilers take vectors apart that are longer than a register.
#if defined(__x86_64__)
  return __builtin_cpu_supports("avx2") != 0 ? 8 : 4;
#else
  return 4;
#endif
}

std::string processor_name() { return processor_property("model name"); }

std::string kernel_compile_options() { return fmt::format("{}", fmt::join(options(), " ")); }

bool precompiles_headers(const KernelCompiler& compiler) {
  // What g++ prints, under whatever name it is called.
  return compiler.version.find("Free Software Foundation") != std::string::npos;
}

std::string precompiled_kernel_header(std::uint32_t lanes) { return first_header(lanes) + ".gch"; }

bool precompile_kernel_headers(const KernelCompiler& compiler, const fs::path& folder, std::uint32_t lanes) {
  write_kernel_headers(folder);
  std::vector<std::string> command = {compiler.path.string()};
  for (std::string& option : options()) command.push_back(std::move(option));
  for (const std::string& argument :
       {std::string("-I"), folder.string(), std::string("-x"), std::string("c++-header"), std::string("-o"),
        (folder / precompiled_kernel_header(lanes)).string(), (folder / first_header(lanes)).string()})
    command.push_back(argument);
  if (lanes != 0) command.push_back(fmt::format("-DTANDEM_LANES={}", lanes));
  const std::optional<ProcessResult> result = run_process(command);
  return result && result->exit_code == 0;
}

std::string compile_kernel(const KernelCompiler& compiler, const fs::path& folder, const fs::path& headers,
                           const KernelBuild& build) {
  if (headers.empty()) write_kernel_headers(folder);
  const fs::path library = folder / "kernel.so";
  std::vector<std::string> command = {compiler.path.string()};
  for (std::string& option : options()) command.push_back(std::move(option));
  if (!build.optimize) command.emplace_back("-O0");  // the last one counts
  if (build.debug_info) command.emplace_back("-g");
  // GLM is installed with the compiler's own headers or beside them; both are on its default path.
  for (const std::string& argument : {std::string("-I"), (headers.empty() ? folder : headers).string(),
                                      std::string("-o"), library.string(), (folder / "kernel.cpp").string()})
    command.push_back(argument);

  const std::optional<ProcessResult> result = run_process(command);
  if (result && result->exit_code == 0 && fs::exists(library)) return {};
  const std::string output = result ? result->output : "the compiler cannot be started";
  std::ofstream(folder / "compiler.log", std::ios::binary) << fmt::format("{}\n{}", fmt::join(command, " "), output);
  const std::string error = first_error_line(output);
  return error.empty() ? fmt::format("exit code {}", result ? result->exit_code : -1) : error;
}

}  // namespace tandem::cpu
