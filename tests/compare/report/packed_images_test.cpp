#include "compare/report/packed_images.hpp"

#include <doctest/doctest.h>
#include <zlib.h>

#include <bit>
#include <string_view>
#include <vector>

#include "compare/report/packing.hpp"
#include "tests/compare/image/images.hpp"

namespace tandem::compare {
namespace {

std::vector<std::uint8_t> unpacked(const std::string& text) {
  static constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<std::uint8_t> compressed;
  std::uint32_t group = 0;
  unsigned bits = 0;
  for (const char character : text) {
    if (character == '=') break;
    group = (group << 6) | static_cast<std::uint32_t>(digits.find(character));
    bits += 6;
    if (bits < 8) continue;
    bits -= 8;
    compressed.push_back(static_cast<std::uint8_t>(group >> bits));
  }
  std::vector<std::uint8_t> bytes(1 << 20);
  uLongf size = bytes.size();
  REQUIRE(uncompress(bytes.data(), &size, compressed.data(), compressed.size()) == Z_OK);
  bytes.resize(size);
  return bytes;
}

TEST_CASE("packed bytes come back, whatever their number") {
  for (const std::size_t count : {0u, 1u, 2u, 3u, 4u, 255u, 1000u}) {
    std::vector<std::uint8_t> bytes;
    for (std::size_t i = 0; i < count; ++i) bytes.push_back(static_cast<std::uint8_t>(i * 37));
    const std::string text = packed(bytes);
    CHECK(text.size() % 4 == 0);
    CHECK(unpacked(text) == bytes);
  }
  const std::vector<std::uint32_t> words = {0x01020304u, 0xffffffffu};
  CHECK(unpacked(packed(words)) == std::vector<std::uint8_t>{4, 3, 2, 1, 255, 255, 255, 255});
}

TEST_CASE("images come back to the last bit from their planes") {
  const pathtracer::Image a = noise_image(31, 7, 1);
  pathtracer::Image b = a;
  b.pixels[100].y = std::bit_cast<float>(0x7fc12345u);  // a NaN with a payload
  b.pixels[216].z = -0.0F;
  const PackedImages images = pack_images(a, b);
  REQUIRE(images.bytes == 4);
  const std::vector<std::uint8_t> planes = unpacked(images.a), both = unpacked(images.exclusive_or);
  const std::size_t pixels = a.pixels.size();
  REQUIRE(planes.size() == 12 * pixels);
  REQUIRE(both.size() == 12 * pixels);
  for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
    for (std::size_t channel = 0; channel < 3; ++channel) {
      std::uint32_t word_a = 0, word_b = 0;
      for (std::size_t byte = 0; byte < 4; ++byte) {
        const std::size_t at = (byte * 3 + channel) * pixels + pixel;
        word_a = (word_a << 8) | planes[at];
        word_b = (word_b << 8) | static_cast<std::uint32_t>(planes[at] ^ both[at]);
      }
      const int i = static_cast<int>(channel);
      CHECK(word_a == std::bit_cast<std::uint32_t>(a.pixels[pixel][i]));
      CHECK(word_b == std::bit_cast<std::uint32_t>(b.pixels[pixel][i]));
    }
  }
  const std::vector<std::uint8_t> differs = unpacked(images.differs);
  REQUIRE(differs.size() == pixels);
  for (std::size_t pixel = 0; pixel < pixels; ++pixel) CHECK(differs[pixel] == (pixel == 100 || pixel == 216 ? 1 : 0));
}

TEST_CASE("images that are too large for the budget lose their last digits") {
  const pathtracer::Image a = noise_image(64, 64, 1), b = noise_image(64, 64, 2);
  const PackedImages whole = pack_images(a, b);
  const std::size_t all = whole.a.size() + whole.exclusive_or.size() + whole.differs.size();
  CHECK(pack_images(a, b, all).bytes == 4);
  const PackedImages less = pack_images(a, b, all - 1);
  CHECK(less.bytes == 3);
  CHECK(less.a.size() < whole.a.size());
  CHECK(pack_images(a, b, 1).bytes == 2);
}

TEST_CASE("exact values are the bits of both images") {
  const pathtracer::Image a = noise_image(5, 5, 1), b = noise_image(5, 5, 2);
  const std::vector<std::uint32_t> pixels = {24, 3};
  const std::vector<std::uint8_t> bytes = unpacked(pack_exact_values(a, b, pixels));
  REQUIRE(bytes.size() == 48);
  const auto word = [&](std::size_t i) {
    return static_cast<std::uint32_t>(bytes[4 * i] | bytes[4 * i + 1] << 8 | bytes[4 * i + 2] << 16) |
           static_cast<std::uint32_t>(bytes[4 * i + 3]) << 24;
  };
  CHECK(word(0) == std::bit_cast<std::uint32_t>(a.pixels[24].x));
  CHECK(word(5) == std::bit_cast<std::uint32_t>(b.pixels[24].z));
  CHECK(word(9) == std::bit_cast<std::uint32_t>(b.pixels[3].x));
}

}  // namespace
}  // namespace tandem::compare
