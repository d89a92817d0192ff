#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "base/statistics/means.hpp"
#include "pathtracer/image/image.hpp"

namespace tandem::compare {

/// What of a pixel is tested: its three channels, and their luminance (ITU-R BT.709), where a bias of all three is seen
/// best.
enum class Channel { red, green, blue, luminance };
inline constexpr std::array channels = {Channel::red, Channel::green, Channel::blue, Channel::luminance};
const char* name(Channel channel);

/// A rectangle of pixels.
struct Tile {
  std::uint32_t left = 0, top = 0, width = 0, height = 0;
};

/// Independent estimates of one picture, its batches, each rendered under a seed of its own: their means over tiles,
/// from which the noise is known, and their mean as a picture. The batches themselves are not kept. Pixels within a
/// batch need not be independent of each other.
class BatchedEstimate {
 public:
  /// @param tile side in pixels, at least 1; what is left over at the right and lower edges forms smaller tiles
  BatchedEstimate(std::uint32_t width, std::uint32_t height, std::uint32_t tile);

  /// Pixels with a NaN or an infinity are left out of the means over tiles, not out of the picture. Throws
  /// Error for a batch of another size.
  void add(const pathtracer::Image& batch);

  std::size_t batches() const noexcept { return batches_; }
  std::span<const Tile> tiles() const noexcept { return tiles_; }

  /// Of the batches, over the tile of that index. At least two batches.
  statistics::Mean tile_mean(std::size_t tile, Channel channel) const;
  /// Likewise over the whole picture.
  statistics::Mean picture_mean(Channel channel) const;
  /// The mean of the batches; black before the first.
  pathtracer::Image image() const;

 private:
  /// Sums over the finite pixels of an area, in one batch.
  struct Sums {
    std::array<double, channels.size()> values{};
    double pixels = 0;
    double mean(Channel channel) const;
  };
  statistics::Mean mean(std::size_t area, Channel channel) const;

  std::uint32_t width_, height_;
  std::size_t batches_ = 0;
  std::vector<Tile> tiles_;
  std::vector<std::vector<Sums>> sums_;  ///< of each tile, then of the picture: one for each batch
  std::vector<glm::dvec3> picture_;      ///< sums of batches
};

/// All batches at once; they have one size.
BatchedEstimate batched(std::span<const pathtracer::Image> batches, std::uint32_t tile);

}  // namespace tandem::compare
