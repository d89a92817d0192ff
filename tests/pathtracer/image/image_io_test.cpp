#include "pathtracer/image/image_io.hpp"

#include <bit>
#include <cmath>
#include <iterator>
#include <limits>

#include <doctest/doctest.h>

#include "base/error.hpp"
#include "base/srgb.hpp"
#include "pathtracer/image/image_codec.hpp"
#include "tests/support/scratch_folder.hpp"

using namespace tandem::pathtracer;
using tandem::test::ScratchFolder;

namespace {

Image ramp(std::uint32_t width, std::uint32_t height) {
  Image image{width, height, {}};
  for (std::uint32_t y = 0; y < height; ++y)
    for (std::uint32_t x = 0; x < width; ++x)
      image.pixels.emplace_back(float(x) / float(width), float(y) / float(height), 17.25f + float(x * y));
  return image;
}

}  // namespace

TEST_CASE("OpenEXR keeps every bit and the metadata") {
  const ScratchFolder folder;
  Image image = ramp(37, 11);
  image.pixels[5] = glm::vec3(1e-30f, 3e38f, -0.0f);
  const ImageMetadata metadata = {{"scene", "a \"b\".obj"}, {"samples", "16"}};
  write_image(folder.path() / "ramp.exr", image, metadata);
  ImageMetadata stored;
  const Image read = read_image(folder.path() / "ramp.exr", &stored);
  CHECK(read.width == 37);
  CHECK(read.height == 11);
  CHECK(read.pixels == image.pixels);
  CHECK(stored == metadata);
  CHECK(folder.names().size() == 1);
}

TEST_CASE("OpenEXR holds layers beside the picture, which stays what it is; PNG has none") {
  const ScratchFolder folder;
  const Image image = ramp(5, 3);
  ImageChannel depth{.name = "depth.Z", .is_integer = false, .words = {}};
  ImageChannel id{.name = "id.primitive", .is_integer = true, .words = {}};
  for (std::uint32_t i = 0; i < 15; ++i) {
    depth.words.push_back(std::bit_cast<std::uint32_t>(0.5f * float(i)));
    id.words.push_back(0xfffffff0u + i);  // floats cannot hold these
  }
  const ImageChannel layers[] = {depth, id};
  write_image(folder.path() / "layers.exr", image, {}, {}, layers);
  CHECK(read_image(folder.path() / "layers.exr").pixels == image.pixels);
  const std::vector<ImageChannel> channels = color_channels(image);
  std::vector<ImageChannel> all = channels;
  all.insert(all.end(), std::begin(layers), std::end(layers));
  // Five channels of four bytes each do not fit into three.
  CHECK(encode_exr(5, 3, all, {}).size() > encode_exr(5, 3, channels, {}).size());
  CHECK_THROWS_WITH_AS(write_image(folder.path() / "layers.png", image, {}, {}, layers),
                       doctest::Contains("only an .exr holds layers"), tandem::Error);
}

TEST_CASE("PNG is sRGB-encoded, clamped and keeps the metadata") {
  const ScratchFolder folder;
  const float infinity = std::numeric_limits<float>::infinity();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const Image image{
      4,
      1,
      {glm::vec3(0, 0.5f, 1), glm::vec3(-1, 2, 0.0031308f), glm::vec3(nan, infinity, -infinity), glm::vec3(0.18f)}};
  write_image(folder.path() / "a.png", image, {{"device", "cpu"}});
  ImageMetadata stored;
  const Image read = read_image(folder.path() / "a.png", &stored);
  REQUIRE(read.pixels.size() == 4);
  // Half a step of 1/255 in the encoding, where its slope is at most 12.92.
  for (std::size_t i : {0u, 3u})
    for (int channel = 0; channel < 3; ++channel)
      CHECK(std::abs(tandem::srgb_encode(read.pixels[i][channel]) - tandem::srgb_encode(image.pixels[i][channel])) <
            0.51f / 255);
  CHECK(read.pixels[1].x == 0);
  CHECK(read.pixels[1].y == 1);
  CHECK(read.pixels[2] == glm::vec3(0, 1, 0));
  CHECK(stored.at("device") == "cpu");
}

TEST_CASE("sRGB agrees with the standard and with its inverse") {
  CHECK(tandem::srgb_encode_8bit(0) == 0);
  CHECK(tandem::srgb_encode_8bit(1) == 255);
  CHECK(tandem::srgb_encode_8bit(0.5f) == 188);   // 1.055 * 0.5^(1/2.4) - 0.055 = 0.7354 = 187.5 / 255
  CHECK(tandem::srgb_encode_8bit(0.18f) == 118);  // 0.4614
  CHECK(tandem::srgb_encode(0.001f) == doctest::Approx(0.01292f));
  for (int i = 0; i <= 255; ++i) CHECK(tandem::srgb_encode_8bit(tandem::srgb_decode(float(i) / 255)) == i);
}

TEST_CASE("A place that cannot be written is known beforehand, and nothing is left there") {
  const ScratchFolder folder;
  folder.write("file", "");
  CHECK_NOTHROW(check_image_path(folder.path() / "a.exr"));
  CHECK_NOTHROW(check_image_path(folder.path() / "a.PNG"));
  CHECK(folder.names().size() == 1);
  for (const std::filesystem::path& path :
       {folder.path(), folder.path() / "a.jpg", folder.path() / "a", folder.path() / "absent" / "a.png",
        folder.path() / "file" / "a.png", std::filesystem::path("/proc/a.png"), std::filesystem::path()}) {
    CAPTURE(path);
    CHECK_THROWS_AS(check_image_path(path), tandem::Error);
    CHECK_THROWS_AS(write_image(path, ramp(2, 2), {}), tandem::Error);
  }
  CHECK(folder.names().size() == 1);
}

TEST_CASE("What is no picture cannot be read") {
  const ScratchFolder folder;
  folder.write("a.exr", "no picture");
  CHECK_THROWS_AS(read_image(folder.path() / "a.exr"), tandem::Error);
  CHECK_THROWS_AS(read_image(folder.path() / "absent.exr"), tandem::Error);
  CHECK_THROWS_AS(write_image(folder.path() / "b.exr", Image{}, {}), tandem::Error);
}

TEST_CASE("A header that claims more than memory holds is an error") {
  const ScratchFolder folder;
  folder.write("a.ppm", "P6\n100000 100000\n255\n");
  CHECK_THROWS_WITH_AS(read_image(folder.path() / "a.ppm"), doctest::Contains("100000x100000"), tandem::Error);
}
