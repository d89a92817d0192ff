#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <initializer_list>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "rhi/compute_pipeline.hpp"
#include "rhi_cpu/kernel/abi.hpp"
#include "rhi_cpu/kernel/shader_call.hpp"
#include "tests/support/scratch_folder.hpp"

/// GLSL to a loaded kernel without a device, for tests of the translator alone.
namespace tandem::test {

struct KernelOptions {
  std::vector<rhi::SpecializationValue> specialization;
  bool optimize = false;                  ///< run spirv-opt's performance passes on the SPIR-V first
  std::vector<std::string> more_options;  ///< of the C++ compiler
  std::uint32_t lanes = 0;                ///< of the wide form; 0: the scalar form
};

/// GLSL compute shader to SPIR-V for Vulkan 1.2, after a #version line that every test shares.
std::vector<std::uint32_t> compute_spirv(const std::string& glsl, bool debug_info = false);

/// GLSL of a stage of a ray tracing pipeline, with GL_EXT_ray_tracing.
std::vector<std::uint32_t> traced_spirv(const std::string& glsl, rhi::ShaderStage stage);

class Kernel {
 public:
  explicit Kernel(const std::string& glsl, const KernelOptions& options = {});
  Kernel(const std::vector<std::uint32_t>& spirv, const KernelOptions& options);
  ~Kernel();
  Kernel(const Kernel&) = delete;
  Kernel& operator=(const Kernel&) = delete;

  const kernel::KernelInfo& info() const { return *info_; }

  /// Runs workgroup_count[0] * [1] * [2] workgroups with the resources in order of (set, binding, element).
  void run(std::initializer_list<kernel::Resource> resources,
           std::initializer_list<std::uint32_t> workgroup_count = {1},
           std::span<const std::byte> push_constants = {}) const {
    run(std::span(resources.begin(), resources.size()), workgroup_count, push_constants);
  }
  void run(std::span<const kernel::Resource> resources, std::initializer_list<std::uint32_t> workgroup_count = {1},
           std::span<const std::byte> push_constants = {}) const;

  /// Runs a shader of a ray tracing stage once.
  void call(kernel::ShaderCall& call) const { info_->call(call); }

 private:
  ScratchFolder folder_;
  void* library_ = nullptr;
  const kernel::KernelInfo* info_ = nullptr;
};

template <typename T>
kernel::Resource resource(std::vector<T>& values) {
  return {reinterpret_cast<std::byte*>(values.data()), values.size() * sizeof(T)};
}

/// Runs one invocation of `statements`, which write to the `count` elements of the T array `result`; `declarations`
/// come before main. With a plain and an optimised module, which must agree.
template <typename T>
std::vector<T> evaluate(const std::string& type, std::size_t count, const std::string& statements,
                        const std::string& declarations = "", KernelOptions options = {}) {
  const std::string source = declarations +
                             "\nlayout(local_size_x = 1) in;\nlayout(std430, binding = 0) buffer Result { " + type +
                             " result[]; };\nvoid main() {\n" + statements + "\n}\n";
  std::vector<T> results[2];
  for (const bool optimize : {false, true}) {
    options.optimize = optimize;
    results[optimize].resize(count);
    Kernel(source, options).run({resource(results[optimize])});
  }
  if (std::memcmp(results[0].data(), results[1].data(), count * sizeof(T)) != 0)
    throw std::runtime_error("the optimised module gives another result");
  return results[0];
}

}  // namespace tandem::test
