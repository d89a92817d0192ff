#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "rhi/texture_format.hpp"
#include "rhi_cpu/kernel/abi.hpp"
#include "tests/rhi_cpu/translate/kernel_harness.hpp"

/// A shader as one invocation after the other and in lanes, for tests that both forms give the same bits.
namespace tandem::test {

/// The first one is the scalar form. 8 lanes have the registers of this machine, 4 those that every x86-64 has.
class Forms {
 public:
  explicit Forms(const std::string& glsl, std::initializer_list<std::uint32_t> lanes = {8}) {
    add(glsl, 0, {});
    for (const std::uint32_t each : lanes)
      add(glsl, each, each == 8 ? std::vector<std::string>{"-march=native"} : std::vector<std::string>{});
  }
  std::size_t count() const { return kernels_.size(); }
  const Kernel& operator[](std::size_t i) const { return *kernels_[i]; }

 private:
  void add(const std::string& glsl, std::uint32_t lanes, const std::vector<std::string>& more_options) {
    kernels_.push_back(std::make_unique<Kernel>(
        glsl, KernelOptions{.specialization = {}, .optimize = true, .more_options = more_options, .lanes = lanes}));
  }
  std::vector<std::unique_ptr<Kernel>> kernels_;
};

using Random = std::mt19937;

/// An image of random bits.
struct RandomImage {
  std::vector<std::byte> texels;
  kernel::Image image;

  RandomImage(Random& random, rhi::TextureFormat format, const std::array<std::uint32_t, 3>& size,
              std::uint32_t sides = 3, std::uint32_t levels = 1)
      : image{.size = {size[0], size[1], size[2]},
              .format = static_cast<std::uint32_t>(format),
              .sides = sides,
              .level_count = levels} {
    std::size_t bytes = 0;
    for (std::uint32_t level = 0; level < levels; ++level) {
      image.level_offsets[level] = bytes;
      std::size_t count = rhi::size_of(format);
      for (std::uint32_t i = 0; i < 3; ++i) count *= i < sides ? std::max(size[i] >> level, 1u) : size[i];
      bytes += count;
    }
    texels.resize(bytes);
    for (std::byte& each : texels) each = static_cast<std::byte>(random());
    image.texels = texels.data();
  }
};

/// GLSL: the words of a vector, in which a NaN is like any other.
inline constexpr const char* words_of_vector = R"(
uvec4 words_of(vec4 v) { return mix(floatBitsToUint(v), uvec4(0x7fc00000u), isnan(v)); }
uvec4 words_of(uvec4 v) { return v; }
uvec4 words_of(ivec4 v) { return uvec4(v); }
)";

/// Any float, but mostly of the size of an image's coordinates.
inline float any_float(Random& random) {
  switch (random() % 16) {
    case 0:
      return std::numeric_limits<float>::quiet_NaN();
    case 1:
      return (random() % 2 == 0 ? 1.0f : -1.0f) * std::numeric_limits<float>::infinity();
    case 2:
      return std::bit_cast<float>(static_cast<std::uint32_t>(random()) & 0xff7fffffu);
    case 3:
      return static_cast<float>(random() % 2000) - 1000.0f;
    case 4:
      return -0.0f;
    default:
      return static_cast<float>(random() % 4096) / 1024.0f - 1.5f;
  }
}

/// A bit for each of 32 invocations that executes: all of them, or some.
inline std::uint32_t any_lanes(Random& random) {
  return random() % 2 == 0 ? ~0u : static_cast<std::uint32_t>(random());
}

}  // namespace tandem::test
