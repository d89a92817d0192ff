#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>

namespace tandem::rhi {

// The numbers of Vulkan's enumerations.
enum class Filter : std::uint32_t { nearest, linear };
enum class AddressMode : std::uint32_t {
  repeat,
  mirrored_repeat,
  clamp_to_edge,
  clamp_to_border,
  mirror_clamp_to_edge
};
enum class CompareOp : std::uint32_t {
  never,
  less,
  equal,
  less_or_equal,
  greater,
  not_equal,
  greater_or_equal,
  always
};
enum class BorderColor : std::uint32_t {
  float_transparent_black,
  int_transparent_black,
  float_opaque_black,
  int_opaque_black,
  float_opaque_white,
  int_opaque_white
};

/// VkSamplerCreateInfo, without anisotropy: no two devices filter that alike.
struct SamplerDesc {
  Filter magnification = Filter::nearest;
  Filter minification = Filter::nearest;
  Filter mipmap = Filter::nearest;
  std::array<AddressMode, 3> address = {};  ///< of u, v and w
  float lod_bias = 0.0f;
  float min_lod = 0.0f;
  float max_lod = 1000.0f;                ///< VK_LOD_CLAMP_NONE
  std::optional<CompareOp> compare = {};  ///< set: what shadow samplers compare with; only they may use the sampler
  BorderColor border = BorderColor::float_transparent_black;
  /// Coordinates are texels: only for 1D and 2D, one level, equal filters and clamped addresses
  /// (VUID-VkSamplerCreateInfo-unnormalizedCoordinates-01072 to -01077).
  bool unnormalized_coordinates = false;
  std::string label;
};

/// How a shader reads a sampled image between its texels.
class Sampler {
 public:
  virtual ~Sampler() = default;
  Sampler(const Sampler&) = delete;
  Sampler& operator=(const Sampler&) = delete;

  const SamplerDesc& desc() const noexcept { return desc_; }

 protected:
  explicit Sampler(SamplerDesc desc) : desc_(std::move(desc)) {}

 private:
  SamplerDesc desc_;
};

using SamplerHandle = std::shared_ptr<Sampler>;

}  // namespace tandem::rhi
