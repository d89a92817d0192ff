#include "pathtracer/image/texture_image.hpp"

#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>

#include <doctest/doctest.h>

#include "base/error.hpp"
#include "base/srgb.hpp"
#include "pathtracer/image/image_codec.hpp"
#include "pathtracer/image/image_io.hpp"
#include "tests/support/scratch_folder.hpp"

using namespace tandem::pathtracer;
using tandem::test::ScratchFolder;

namespace {

template <typename T>
std::vector<T> values_of(const TextureImage& image) {
  std::vector<T> values(image.texels.size() / sizeof(T));
  std::memcpy(values.data(), image.texels.data(), values.size() * sizeof(T));
  return values;
}

using Bytes = std::vector<std::uint8_t>;

const std::string two_pixels = "P3\n2 1\n255\n255 128 0  1 2 3\n";
/// A PNG file of 16 bits: (65535, 32768, 0) and (1, 2, 3).
const Bytes two_wide_pixels = {
    0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48, 0x44, 0x52, 0x00, 0x00, 0x00,
    0x02, 0x00, 0x00, 0x00, 0x01, 0x10, 0x02, 0x00, 0x00, 0x00, 0x2b, 0xd0, 0x34, 0x9e, 0x00, 0x00, 0x00, 0x13, 0x49,
    0x44, 0x41, 0x54, 0x78, 0x9c, 0x63, 0xf8, 0xff, 0xbf, 0x81, 0x01, 0x08, 0x18, 0x19, 0x98, 0x18, 0x98, 0x01, 0x1c,
    0x04, 0x02, 0x85, 0x6b, 0xcf, 0xbf, 0x4d, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};

std::vector<std::byte> bytes_of(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  const auto bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

std::string error_of(const auto& action) {
  try {
    action();
  } catch (const tandem::Error& error) {
    return error.what();
  }
  return "no error";
}

bool contains(const std::string& text, std::string_view part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("Eight bits stay as they are, as colours or as data") {
  const ScratchFolder folder;
  const auto path = folder.write("a.ppm", two_pixels);
  const TextureImage color = load_texture_image(path, TextureEncoding::color);
  CHECK(color.name == "a.ppm");
  CHECK(color.width == 2);
  CHECK(color.height == 1);
  CHECK(color.format == TexelFormat::srgb8);
  CHECK(values_of<std::uint8_t>(color) == Bytes{255, 128, 0, 255, 1, 2, 3, 255});
  const TextureImage data = load_texture_image(path, TextureEncoding::data);
  CHECK(data.format == TexelFormat::unorm8);
  CHECK(data.texels == color.texels);
  const TextureImage grey = load_texture_image(folder.write("b.pgm", "P2\n2 1\n255\n7 9\n"), TextureEncoding::data);
  CHECK(values_of<std::uint8_t>(grey) == Bytes{7, 7, 7, 255, 9, 9, 9, 255});
}

TEST_CASE("Sixteen bits stay as data, and become linear floats as colours") {
  const auto file = std::as_bytes(std::span(two_wide_pixels));
  const TextureImage data = decode_texture_image(file, "a", TextureEncoding::data);
  CHECK(data.format == TexelFormat::unorm16);
  CHECK(values_of<std::uint16_t>(data) == std::vector<std::uint16_t>{65535, 32768, 0, 65535, 1, 2, 3, 65535});
  const TextureImage color = decode_texture_image(file, "a", TextureEncoding::color);
  CHECK(color.format == TexelFormat::float32);
  const std::vector<float> values = values_of<float>(color);
  REQUIRE(values.size() == 8);
  CHECK(values[0] == 1);
  CHECK(values[1] == tandem::srgb_decode(32768 / 65535.0f));
  CHECK(values[2] == 0);
  CHECK(values[3] == 1);
}

TEST_CASE("Floats stay as they are, but for what no shader may meet") {
  const float infinity = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<glm::vec3> pixels = {{17.25f, 1e-19f, -2}, {infinity, nan, -1e-21f}};
  const std::vector<std::byte> file = encode_exr(2, 1, color_channels({2, 1, pixels}), {});
  const TextureImage data = decode_texture_image(file, "sky", TextureEncoding::data);
  CHECK(data.name == "sky");
  CHECK(data.format == TexelFormat::float32);
  CHECK(values_of<float>(data) == std::vector<float>{17.25f, 1e-19f, -2, 1, 0, 0, 0, 1});
  const TextureImage color = decode_texture_image(file, "sky", TextureEncoding::color);
  CHECK(values_of<float>(color) == std::vector<float>{17.25f, 1e-19f, 0, 1, 0, 0, 0, 1});
}

TEST_CASE("An image in memory is the image in its file, alpha and colours apart") {
  const auto path = std::filesystem::path(TANDEM_SOURCE_DIRECTORY) / "scenes" / "leaf.png";
  const TextureImage loaded = load_texture_image(path, TextureEncoding::color);
  const TextureImage decoded = decode_texture_image(bytes_of(path), "leaf", TextureEncoding::color);
  CHECK(loaded.width == 64);
  CHECK(loaded.texels == decoded.texels);
  // Transparent white: not darkened by its alpha.
  CHECK(std::to_integer<int>(loaded.texels[0]) == 255);
  CHECK(std::to_integer<int>(loaded.texels[3]) == 0);
}

TEST_CASE("Bytes that are no image are an error that names them") {
  CHECK(contains(error_of([] { decode_texture_image({}, "image 3", TextureEncoding::data); }), "image 3"));
  const std::vector<std::byte> cut = [] {
    std::vector<std::byte> file = encode_png(4, 4, Bytes(48, 100), {});
    file.resize(40);
    return file;
  }();
  CHECK(contains(error_of([&] { decode_texture_image(cut, "image 4", TextureEncoding::data); }), "image 4"));
  CHECK(contains(error_of([] { load_texture_image("/absent.png", TextureEncoding::data); }), "/absent.png"));
}
