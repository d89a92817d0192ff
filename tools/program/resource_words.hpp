#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "program/job/value_type.hpp"
#include "rhi/sampler.hpp"
#include "rhi/texture_format.hpp"
#include "tools/program/run_options.hpp"

/// The values of --buffer, --image and --sampler. All functions throw Error, which begins with the setting's `where`.
namespace tandem::tools::program_run {

enum class SourceKind { zeros, iota, random, values, file };

/// Where first contents come from.
struct Source {
  SourceKind kind = SourceKind::zeros;
  std::uint64_t seed = 0;
  std::optional<std::array<double, 2>> range = {};  ///< of random numbers
  std::vector<std::string> values = {};
  std::filesystem::path file = {};
};

/// zeros:1024, iota:4KiB:vec4, random:7:100:-1..1, 1,2,3, data.npy, data.bin:uint
struct BufferWords {
  Source source;
  std::optional<std::uint64_t> elements = {};
  std::optional<std::uint64_t> bytes = {};
  std::optional<program::ValueType> type = {};    ///< what its elements are, in place of what the shader says
  std::optional<rhi::TextureFormat> format = {};  ///< of a texel buffer
};
BufferWords buffer_words(const Setting& setting);

/// rgba8:512x512, picture.png, r32f:64x64x8:random:3, levels=4
struct ImageWords {
  Source source;
  std::optional<rhi::TextureFormat> format = {};
  std::optional<std::array<std::uint32_t, 3>> size = {};
  std::uint32_t levels = 1;
};
ImageWords image_words(const Setting& setting);

/// Words such as linear, nearest, repeat, mirror, clamp, border, less, unnormalized.
rhi::SamplerDesc sampler_words(const Setting& setting);

/// One to three numbers of at least 1, separated by 'x' or ','; the others are 1.
std::array<std::uint32_t, 3> three_sizes(const Setting& setting);

/// "rgba8_unorm", or as GLSL has it: "rgba8", "r32f", "rg16ui".
std::optional<rhi::TextureFormat> format_named(std::string_view word);

/// Throws Error "WHERE: SENTENCE".
[[noreturn]] void refuse(const Setting& setting, const std::string& sentence);

}  // namespace tandem::tools::program_run
