#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "rhi/texture.hpp"

namespace tandem::rhi {

enum class ShaderStage { compute, ray_generation, any_hit, closest_hit, miss, intersection, callable };

enum class BindingKind {
  uniform_buffer,
  storage_buffer,
  acceleration_structure,
  storage_image,
  sampled_image,
  sampler,
  combined_image_sampler,
  uniform_texel_buffer,
  storage_texel_buffer
};

/// One descriptor, or an array of them, that a shader declares and statically uses.
struct ShaderBinding {
  std::uint32_t set = 0;
  std::uint32_t binding = 0;
  std::uint32_t count = 1;  ///< array length; 0: an array without a length
  BindingKind kind = BindingKind::storage_buffer;
  bool writable = false;                              ///< a storage buffer, image or texel buffer without NonWritable
  TextureDimension dimension = TextureDimension::d2;  ///< of an image
  /// Of an image or texel buffer: what the components of its texels are read as; unorm, snorm and depth are floating.
  ComponentKind component = ComponentKind::floating;
  bool compares = false;  ///< a sampled image with which a sampler compares: sampler2DShadow
  /// Of a storage image or storage texel buffer; absent where the shader names none.
  std::optional<TextureFormat> format;
  std::string name;
};

/// A specialisation constant that has a SpecId.
struct SpecializationConstant {
  std::uint32_t id = 0;             ///< layout(constant_id = id)
  std::uint64_t default_value = 0;  ///< the bits, from the lowest one on; bool: 0 or 1
  std::string name;
  std::uint32_t width = 32;  ///< bits of a value; of a bool 32
};

/// What a pipeline has to know about a module. Bindings are sorted by (set, binding).
struct ShaderReflection {
  ShaderStage stage = ShaderStage::compute;
  std::string entry_point;
  std::array<std::uint32_t, 3> workgroup_size = {1, 1, 1};  ///< before specialisation; compute only
  /// The SpecId that sets a dimension of the workgroup size, where one does.
  std::array<std::optional<std::uint32_t>, 3> workgroup_size_constant;
  std::uint32_t push_constant_size = 0;  ///< bytes, 0 without a push constant block
  std::uint32_t shader_record_size = 0;  ///< bytes of the shaderRecordEXT block, 0 without one
  std::vector<ShaderBinding> bindings;
  std::vector<SpecializationConstant> specialization_constants;
};

/// Validates the words, then reads them. Throws Error(invalid_argument) when they are no valid SPIR-V or hold not
/// exactly one entry point, Error(unsupported) for a stage or a resource that is not listed above; both name `label`.
ShaderReflection reflect(std::span<const std::uint32_t> spirv, std::string_view label);

/// reflect() of words that have passed the validator, or were made from such words. Anything else may crash the parser.
ShaderReflection reflect_valid(std::span<const std::uint32_t> spirv, std::string_view label);

}  // namespace tandem::rhi
