#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "program/record/module.hpp"

/// Values as the recording has them: 32-bit words, one for each scalar, two for one of 64 bits.
namespace tandem::program {

enum class ComponentKind : std::uint8_t { boolean, signed_integer, unsigned_integer, floating };

/// A scalar inside of a value.
struct Component {
  std::vector<std::uint32_t> path = {};  ///< OpCompositeExtract's indices; none where the value is a scalar
  ComponentKind kind = ComponentKind::unsigned_integer;
  std::uint32_t width = 32;  ///< bits; of a boolean 32: 0 or 1
  std::uint32_t word = 0;    ///< the first of its words, among those of the value

  std::uint32_t word_count() const noexcept { return width == 64 ? 2 : 1; }
};

/// A value as it was recorded.
struct RecordedWords {
  std::vector<Component> components;
  std::vector<std::uint32_t> words;
};

/// Values of more words are not recorded.
inline constexpr std::uint32_t most_words = 64;

/// The scalars of a type; nothing where it has pointers or opaque members, or is larger than most_words.
std::optional<std::vector<Component>> components_of(const Module& module, std::uint32_t type);

/// What is recorded of a component of less than 32 bits that a module's constant holds in these bits: an integer
/// without a sign, or a float of 16 bits as one of 32.
std::uint32_t recorded_word(const Component& component, std::uint32_t bits);

/// Words of such a value.
std::uint32_t word_count(const std::vector<Component>& components);

}  // namespace tandem::program
