#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "rhi/shader_reflection.hpp"

namespace tandem::rhi {

/// SPIR-V, the same words on every backend.
struct ShaderModuleDesc {
  std::span<const std::uint32_t> spirv;  ///< copied by create_shader_module
  std::string label;
  /// The words have passed the validator before, as those of a program's own shaders when it was built: they are not
  /// validated again, which takes tenths of a second for large ones. Others may crash the program.
  bool known_valid = false;
  std::string entry_point = {};  ///< of a module that has several; "": the only one
};

/// A SPIR-V module of one entry point (of several, the others are removed), and what reflection says of it.
class ShaderModule {
 public:
  virtual ~ShaderModule() = default;
  ShaderModule(const ShaderModule&) = delete;
  ShaderModule& operator=(const ShaderModule&) = delete;

  const std::string& label() const noexcept { return label_; }
  const ShaderReflection& reflection() const noexcept { return reflection_; }
  std::span<const std::uint32_t> spirv() const noexcept { return spirv_; }

 protected:
  /// Copies the words and reflects them. Throws Error(invalid_argument) when they are no SPIR-V module.
  explicit ShaderModule(const ShaderModuleDesc& desc);

 private:
  std::string label_;
  std::vector<std::uint32_t> spirv_;
  ShaderReflection reflection_;
};

using ShaderModuleHandle = std::shared_ptr<ShaderModule>;

}  // namespace tandem::rhi
