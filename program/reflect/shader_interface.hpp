#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "program/job/job.hpp"
#include "program/job/value_type.hpp"
#include "rhi/shader_reflection.hpp"

namespace tandem::program {

/// A uniform or storage block, as the shader declares it.
struct BlockLayout {
  std::uint32_t set = 0;
  std::uint32_t binding = 0;
  std::string block;     ///< the name behind `buffer` or `uniform`
  std::string instance;  ///< the name behind the block; "" without one
  ValueType type;        ///< a structure
};

/// A specialisation constant with its type.
struct ConstantLayout {
  std::uint32_t id = 0;
  std::string name;
  ScalarType type = ScalarType::uint32;
  bool is_bool = false;             ///< then 0 or 1, and `type` is uint32
  std::uint64_t default_value = 0;  ///< the bits
};

/// What has to be given to a shader.
struct ShaderInterface {
  rhi::ShaderReflection reflection;
  std::vector<BlockLayout> blocks;          ///< sorted by (set, binding); several where variables share a binding
  std::optional<ValueType> push_constants;  ///< a structure
  std::optional<ValueType> shader_record;   ///< likewise
  std::vector<ConstantLayout> constants;    ///< sorted by id
};

/// Reads the module. Members without a name are called "member0" and so on; an array whose length is a specialisation
/// constant has that constant's default. Throws rhi::Error in the shader's name, as rhi::reflect does.
ShaderInterface interface_of(const Shader& shader);

/// Whether a user may call the binding so: by its name in the reflection, that of its block, of its instance, or of
/// the only member of the block.
bool is_called(const ShaderInterface& shader, const rhi::ShaderBinding& binding, std::string_view name);

/// The block at a place, the first of several; null where there is none.
const BlockLayout* block_at(const ShaderInterface& shader, std::uint32_t set, std::uint32_t binding);

/// What a buffer for the block holds: of a block with one member that member, else the block itself.
ValueType contents_type(const ValueType& block);

}  // namespace tandem::program
