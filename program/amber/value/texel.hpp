#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "program/job/value_type.hpp"
#include "rhi/texture_format.hpp"

namespace tandem::program::amber {

/// How a component's bits are a number: the last word of a format's name.
enum class Encoding : std::uint8_t { unorm, snorm, uint, sint, uscaled, sscaled, srgb, sfloat, ufloat };

/// One component of a texel.
struct Component {
  char name = 'R';  ///< R, G, B, A, D (depth), S (stencil) or X (unused)
  std::uint32_t bits = 8;
  std::uint32_t offset = 0;  ///< of its lowest bit in the texel
  Encoding encoding = Encoding::unorm;
};

/// A format by the name that Vulkan has for it, such as R8G8B8A8_UNORM.
struct Texel {
  std::string name;
  std::vector<Component> components;              ///< in the order of the name
  std::uint32_t size = 4;                         ///< bytes
  bool packed = false;                            ///< one number in a script, of all bits
  std::optional<rhi::TextureFormat> format = {};  ///< empty where our devices have none
};

/// Empty for a word that is no format.
std::optional<Texel> parse_texel(std::string_view name);

/// The format of a scalar or vector type: R32G32_SFLOAT of vec2<float>. Empty where there is none.
std::optional<Texel> texel_of(const ValueType& type);

/// What the texel is in memory: a vector of its components, or a single number.
ValueType value_type_of(const Texel& texel);

/// The component's value as a shader reads it: unorm in [0, 1], srgb linear. @pre as many bytes as a texel has
double value_of(const Component& component, std::span<const std::byte> texel);

}  // namespace tandem::program::amber
