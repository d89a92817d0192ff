#include "tests/rhi_cpu/translate/kernel_harness.hpp"

#include <dlfcn.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>

#include <spirv-tools/optimizer.hpp>

#include "rhi/glsl/compile.hpp"
#include "rhi_cpu/translate/compile_options.hpp"
#include "rhi_cpu/translate/translate.hpp"

namespace tandem::test {

namespace fs = std::filesystem;

namespace {

std::vector<std::uint32_t> optimized(const std::vector<std::uint32_t>& spirv) {
  spvtools::Optimizer optimizer(SPV_ENV_VULKAN_1_2);
  optimizer.RegisterPerformancePasses();
  std::vector<std::uint32_t> result;
  if (!optimizer.Run(spirv.data(), spirv.size(), &result)) throw std::runtime_error("spirv-opt failed");
  return result;
}

/// The compiler with the options of every kernel.
std::string compiler_command() {
  std::string command = TANDEM_TEST_COMPILER " -shared -fPIC";
  for (const char* option : cpu::compile_options) command += std::string(" ") + option;
  return command;
}

/// A folder of the kernel headers in which g++ finds them precompiled, which makes a small kernel three times as fast.
const fs::path& kernel_headers() {
  static const ScratchFolder folder;
  static const bool written = [] {
    const fs::path headers = folder.path() / "rhi_cpu/kernel";
    fs::create_directories(headers.parent_path());
    fs::copy(TANDEM_SOURCE_DIRECTORY "/rhi_cpu/kernel", headers, fs::copy_options::recursive);
    const std::string header = (headers / "kernel.hpp").string();
    const std::string command =
        compiler_command() + " -I " + folder.path().string() + " -x c++-header -o " + header + ".gch " + header;
    if (std::system(command.c_str()) != 0) throw std::runtime_error("the kernel headers do not compile");
    return true;
  }();
  static_cast<void>(written);
  return folder.path();
}

}  // namespace

std::vector<std::uint32_t> compute_spirv(const std::string& glsl, bool debug_info) {
  glsl::CompileOptions options;
  options.debug_info = debug_info;
  return glsl::compile("#version 460\n" + glsl, rhi::ShaderStage::compute, "test.comp", options);
}

std::vector<std::uint32_t> traced_spirv(const std::string& glsl, rhi::ShaderStage stage) {
  return glsl::compile("#version 460\n#extension GL_EXT_ray_tracing : require\n" + glsl, stage, "test.glsl");
}

Kernel::Kernel(const std::string& glsl, const KernelOptions& options) : Kernel(compute_spirv(glsl), options) {}

Kernel::Kernel(const std::vector<std::uint32_t>& spirv, const KernelOptions& options) {
  const cpu::Translation translation =
      cpu::translate(options.optimize ? optimized(spirv) : spirv, "test.comp",
                     {.specialization = options.specialization, .lanes = options.lanes});
  const fs::path source = folder_.path() / "kernel.cpp";
  const fs::path library = folder_.path() / "kernel.so";
  std::ofstream(source) << translation.source;
  std::string command = compiler_command() + " -I " + kernel_headers().string();
  for (const std::string& option : options.more_options) command += " " + option;
  command += " -o " + library.string() + " " + source.string();
  if (std::system(command.c_str()) != 0)
    throw std::runtime_error("the translated kernel does not compile: " + source.string());
  library_ = dlopen(library.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library_ == nullptr) throw std::runtime_error(dlerror());
  info_ = reinterpret_cast<kernel::EntryFunction>(dlsym(library_, kernel::entry_symbol))();
}

Kernel::~Kernel() { dlclose(library_); }

void Kernel::run(std::span<const kernel::Resource> resources, std::initializer_list<std::uint32_t> workgroup_count,
                 std::span<const std::byte> push_constants) const {
  kernel::Dispatch dispatch;
  dispatch.resources = resources.data();
  dispatch.push_constants = push_constants.data();
  std::copy(workgroup_count.begin(), workgroup_count.end(), dispatch.workgroup_count);
  const std::uint64_t workgroups =
      std::uint64_t{dispatch.workgroup_count[0]} * dispatch.workgroup_count[1] * dispatch.workgroup_count[2];
  info_->run(dispatch, 0, workgroups);
}

}  // namespace tandem::test
