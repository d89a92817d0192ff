#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "rhi/texture_format.hpp"
#include "rhi_cpu/kernel/abi.hpp"

/// One kernel, compiled once, that samples in every way that GLSL has for a compute shader.
namespace tandem::test {

/// Instructions by the GLSL that makes them; the words behind are the image's dimension.
enum class Ask : std::int32_t {
  level_d1,
  level_d2,
  level_d3,
  level_cube,
  level_d1_array,
  level_d2_array,
  level_cube_array,
  gradients_d1,
  gradients_d2,
  gradients_d3,
  gradients_cube,
  limited_gradients_d2,  ///< with a least level of detail of Query::detail
  shifted_d2,            ///< by (1, -2)
  projected_d2,          ///< divided by z
  projected_d3,          ///< divided by w
  gather_d2,             ///< of green
  gather_d2_array,       ///< of alpha
  gather_cube,           ///< of red
  gather_shifted_d2,     ///< of blue, by (1, 0)
  gather_offsets_d2,     ///< of red, at (0, 0), (1, 0), (0, 1), (-1, -1)
  compare_d2,            ///< with z
  compare_projected_d2,  ///< with z / w
  compare_d1_array,      ///< with z
  compare_cube,          ///< with w, and gradients
  gather_compare_d2,     ///< with Query::detail
  gather_compare_shifted_d2,
  gather_compare_cube_array,
};

using Four = std::array<float, 4>;

struct Query {
  Ask ask = Ask::level_d2;
  Four at = {};
  float detail = 0.0f;
  Four dx = {};
  Four dy = {};
};

/// What the shader's instruction gives: four components, or the first of them.
Four sampled(const kernel::Image& image, const kernel::Sampler& sampler, const Query& query);

/// Texels of an image with its levels, one float each or four.
class TestImage {
 public:
  /// @param levels texels of each level
  TestImage(std::array<std::uint32_t, 3> size, std::uint32_t sides, const std::vector<std::vector<float>>& levels,
            rhi::TextureFormat format = rhi::TextureFormat::r32_float);
  TestImage(const TestImage&) = delete;
  TestImage& operator=(const TestImage&) = delete;

  const kernel::Image& image() const { return image_; }
  Four sampled(const kernel::Sampler& sampler, const Query& query) const {
    return test::sampled(image_, sampler, query);
  }

 private:
  std::vector<float> texels_;
  kernel::Image image_;
};

}  // namespace tandem::test
