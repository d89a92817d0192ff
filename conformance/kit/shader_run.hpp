#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "conformance/kit/context.hpp"

/// Compute shaders that answer in words: binding 0 of set 0 is a buffer of uint.
namespace tandem::conformance {

using Words = std::vector<std::uint32_t>;

struct ShaderRun {
  std::string label;
  std::string glsl;                               ///< after the #version line
  std::vector<rhi::BindGroupEntry> entries = {};  ///< of set 0, but for binding 0
  Words push_constants = {};
  std::array<std::uint32_t, 3> workgroup_count = {1, 1, 1};
  ComputeOptions options = {};
};

/// The `count` words of binding 0, which are zero before the shader runs.
Words answers(Context& context, const ShaderRun& run, std::size_t count);

/// The text with every `what` replaced.
std::string with(std::string text, const std::string& what, const std::string& replacement);

/// The words as floats.
std::vector<float> floats_of(std::span<const std::uint32_t> words);

/// A storage buffer of these words.
rhi::BufferHandle words_buffer(rhi::Device& device, const Words& words, const std::string& label);

/// Throws Failure, naming the first word that is another.
void check_words(const Words& seen, const Words& expected);

}  // namespace tandem::conformance
