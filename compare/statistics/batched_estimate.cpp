#include "compare/statistics/batched_estimate.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"

namespace tandem::compare {

using namespace statistics;
namespace {

constexpr std::size_t index(Channel channel) { return static_cast<std::size_t>(channel); }

double luminance(const glm::dvec3& color) { return 0.2126 * color.x + 0.7152 * color.y + 0.0722 * color.z; }

}  // namespace

const char* name(Channel channel) {
  static constexpr std::array names = {"red", "green", "blue", "luminance"};
  return names[index(channel)];
}

double BatchedEstimate::Sums::mean(Channel channel) const { return pixels > 0 ? values[index(channel)] / pixels : 0.0; }

BatchedEstimate::BatchedEstimate(std::uint32_t width, std::uint32_t height, std::uint32_t tile)
    : width_(width), height_(height), picture_(std::size_t{width} * height) {
  for (std::uint32_t top = 0; top < height; top += std::min(tile, height - top))
    for (std::uint32_t left = 0; left < width; left += std::min(tile, width - left))
      tiles_.push_back(
          {.left = left, .top = top, .width = std::min(tile, width - left), .height = std::min(tile, height - top)});
  sums_.resize(tiles_.size() + 1);
}

void BatchedEstimate::add(const pathtracer::Image& batch) {
  if (batch.width != width_ || batch.height != height_ || batch.pixels.size() != picture_.size())
    throw Error("batches of one estimate must have one size");
  Sums all;
  for (std::size_t i = 0; i < tiles_.size(); ++i) {
    const Tile& tile = tiles_[i];
    Sums sums;
    for (std::uint32_t y = tile.top; y < tile.top + tile.height; ++y)
      for (std::uint32_t x = tile.left; x < tile.left + tile.width; ++x) {
        const glm::dvec3 color(batch.at(x, y));
        if (!std::isfinite(color.x) || !std::isfinite(color.y) || !std::isfinite(color.z)) continue;
        const std::array<double, channels.size()> values = {color.x, color.y, color.z, luminance(color)};
        for (std::size_t c = 0; c < values.size(); ++c) sums.values[c] += values[c];
        sums.pixels += 1;
      }
    for (std::size_t c = 0; c < sums.values.size(); ++c) all.values[c] += sums.values[c];
    all.pixels += sums.pixels;
    sums_[i].push_back(sums);
  }
  sums_.back().push_back(all);
  for (std::size_t i = 0; i < picture_.size(); ++i) picture_[i] += glm::dvec3(batch.pixels[i]);
  ++batches_;
}

Mean BatchedEstimate::mean(std::size_t area, Channel channel) const {
  std::vector<double> means;
  for (const Sums& sums : sums_[area]) means.push_back(sums.mean(channel));
  return mean_of(means);
}

Mean BatchedEstimate::tile_mean(std::size_t tile, Channel channel) const { return mean(tile, channel); }

Mean BatchedEstimate::picture_mean(Channel channel) const { return mean(tiles_.size(), channel); }

pathtracer::Image BatchedEstimate::image() const {
  pathtracer::Image image{.width = width_, .height = height_, .pixels = {}};
  const double count = static_cast<double>(std::max<std::size_t>(batches_, 1));
  for (const glm::dvec3& sum : picture_) image.pixels.emplace_back(sum / count);
  return image;
}

BatchedEstimate batched(std::span<const pathtracer::Image> batches, std::uint32_t tile) {
  BatchedEstimate estimate(batches.front().width, batches.front().height, tile);
  for (const pathtracer::Image& batch : batches) estimate.add(batch);
  return estimate;
}

}  // namespace tandem::compare
