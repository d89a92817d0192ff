#include "compare/report/packed_images.hpp"

#include <bit>
#include <vector>

#include "compare/image/image_pair.hpp"
#include "compare/report/packing.hpp"

namespace tandem::compare {
namespace {

using pathtracer::Image;

std::uint32_t bits(const Image& image, std::size_t pixel, int channel) {
  return std::bit_cast<std::uint32_t>(image.pixels[pixel][channel]);
}

/// The planes of the highest bytes of word(pixel, channel).
template <typename Word>
std::string pack_planes(std::size_t pixels, std::uint32_t bytes, Word word) {
  std::vector<std::uint8_t> planes;
  planes.reserve(pixels * 3 * bytes);
  for (std::uint32_t byte = 0; byte < bytes; ++byte)
    for (int channel = 0; channel < 3; ++channel)
      for (std::size_t pixel = 0; pixel < pixels; ++pixel)
        planes.push_back(static_cast<std::uint8_t>(word(pixel, channel) >> (24 - 8 * byte)));
  return packed(planes);
}

}  // namespace

PackedImages pack_images(const Image& a, const Image& b, std::size_t budget) {
  check_pair(a, b);
  const std::size_t pixels = a.pixels.size();
  const auto both = [&](std::size_t pixel, int channel) { return bits(a, pixel, channel) ^ bits(b, pixel, channel); };
  PackedImages result;
  std::vector<std::uint8_t> differs(pixels);
  for (std::size_t pixel = 0; pixel < pixels; ++pixel)
    differs[pixel] = (both(pixel, 0) | both(pixel, 1) | both(pixel, 2)) != 0 ? 1 : 0;
  result.differs = packed(differs);
  for (result.bytes = 4;; --result.bytes) {
    result.a =
        pack_planes(pixels, result.bytes, [&](std::size_t pixel, int channel) { return bits(a, pixel, channel); });
    result.exclusive_or = pack_planes(pixels, result.bytes, both);
    if (result.bytes == 2 || result.a.size() + result.exclusive_or.size() + result.differs.size() <= budget)
      return result;
  }
}

std::string pack_exact_values(const Image& a, const Image& b, std::span<const std::uint32_t> pixel_indices) {
  std::vector<std::uint32_t> words;
  words.reserve(6 * pixel_indices.size());
  for (const std::uint32_t pixel : pixel_indices) {
    for (int channel = 0; channel < 3; ++channel) words.push_back(bits(a, pixel, channel));
    for (int channel = 0; channel < 3; ++channel) words.push_back(bits(b, pixel, channel));
  }
  return packed(words);
}

}  // namespace tandem::compare
