#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <set>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "rhi/device.hpp"
#include "tests/family/generator.hpp"

/// Ways to run a generated shader. All must give the same bytes.
namespace tandem::family {

inline constexpr std::uint32_t workgroup_count[3] = {3, 2, 1};

/// What a shader is run on: by binding; and what it writes, bindings 2 and 3.
struct ShaderData {
  std::vector<std::vector<std::byte>> buffers;
  std::vector<std::byte> push_constants;
};
ShaderData data_for(const GeneratedShader& shader, std::uint32_t seed);

/// What a shader has written.
using Results = std::vector<std::byte>;

/// How the CPU device's translator prints a kernel.
struct Form {
  std::uint32_t lanes = 0;  ///< 0: the scalar form
  bool robust = false;
};
std::string name_of(const Form& form);

/// Thrown where a shader does not come to a result; what() is the kind of failure in a line.
struct Failure : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The shader as SPIR-V; empty where glslang crashes, as it does on some constants of 8, 16 and 64 bits.
std::vector<std::uint32_t> compiled(const ShaderTree& tree);

/// The module after spirv-opt's pass of the name: "-O", "--loop-unroll"; "": as it is.
std::vector<std::uint32_t> optimized(const std::vector<std::uint32_t>& spirv, const std::string& pass);

/// Translates modules and runs the kernels in a process of their own. Keeps precompiled headers in its folder.
class KernelRunner {
 public:
  /// @param optimization of the C++ compiler: "-O1"
  KernelRunner(std::filesystem::path folder, std::string optimization);
  /// Throws Failure.
  Results run(const std::vector<std::uint32_t>& spirv, const Form& form, const ShaderData& data);

 private:
  std::string prepared(std::uint32_t lanes);
  std::filesystem::path folder_;
  std::string optimization_;
  std::set<std::uint32_t> prepared_;
};

Results run_on_device(rhi::Device& device, const std::vector<std::uint32_t>& spirv, const ShaderData& data);

}  // namespace tandem::family
