#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "rhi/shader_module.hpp"

namespace tandem::rhi {

/// The value of one specialisation constant: its bits, the lowest ones where it has less than 64; bool: 0 or 1.
struct SpecializationValue {
  std::uint32_t id = 0;
  std::uint64_t value = 0;
};

/// What the shaders of a pipeline bind, together.
struct PipelineInterface {
  std::vector<ShaderBinding> bindings;     ///< sorted by (set, binding), each once; writable where any shader writes
  std::uint32_t unsized_array_length = 0;  ///< most elements of the arrays without a length, whose count is 0
  std::uint32_t push_constant_size = 0;    ///< bytes: the largest block of a shader; 0 without one
};

/// Elements that a bind group may give to an array of descriptors without a length, unless a pipeline says more.
inline constexpr std::uint32_t usual_unsized_array_length = 1024;

/// Throws Error(invalid_argument), in the name of `label`, when two shaders declare a binding differently.
PipelineInterface combined_interface(std::span<const ShaderModuleHandle> shaders, std::string_view label,
                                     std::uint32_t unsized_array_length = usual_unsized_array_length);

/// The most elements of a binding.
inline std::uint32_t capacity(const PipelineInterface& interface, const ShaderBinding& binding) {
  return binding.count != 0 ? binding.count : interface.unsized_array_length;
}

/// What compute and ray tracing pipelines have in common: bind groups are made for it.
class Pipeline {
 public:
  enum class Kind { compute, ray_tracing };

  virtual ~Pipeline() = default;
  Pipeline(const Pipeline&) = delete;
  Pipeline& operator=(const Pipeline&) = delete;

  Kind kind() const noexcept { return kind_; }
  const std::string& label() const noexcept { return label_; }
  const PipelineInterface& interface() const noexcept { return interface_; }

 protected:
  Pipeline(Kind kind, std::string label, PipelineInterface interface)
      : kind_(kind), label_(std::move(label)), interface_(std::move(interface)) {}

 private:
  Kind kind_;
  std::string label_;
  PipelineInterface interface_;
};

using PipelineHandle = std::shared_ptr<Pipeline>;

}  // namespace tandem::rhi
