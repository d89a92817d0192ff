#include "tools/view/display.hpp"

#include <doctest/doctest.h>

#include <bit>
#include <filesystem>
#include <limits>
#include <utility>

#include "pathtracer/image/image_io.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tools/view/preview.hpp"

namespace tandem::view {
namespace {

using Rgb = std::array<int, 3>;

pathtracer::Image uniform(glm::vec3 color) { return {4, 2, std::vector(8, color)}; }

Rgb at(const Picture& picture, std::uint32_t x, std::uint32_t y) {
  const std::size_t i = (std::size_t{y} * picture.width + x) * 4;
  CHECK(picture.bytes[i + 3] == 255);
  return {picture.bytes[i], picture.bytes[i + 1], picture.bytes[i + 2]};
}

const pathtracer::Image red = uniform({1, 0, 0}), green = uniform({0, 1, 0}), blue = uniform({0, 0, 1});

TEST_CASE("each mode shows what it is called") {
  const auto shown = [](DisplayMode mode, bool flicker_b = false) {
    return compose(red, green, &blue, {.mode = mode, .flicker_b = flicker_b});
  };
  CHECK(at(shown(DisplayMode::a), 3, 1) == Rgb{255, 0, 0});
  CHECK(at(shown(DisplayMode::b), 3, 1) == Rgb{0, 255, 0});
  CHECK(at(shown(DisplayMode::flicker), 0, 0) == Rgb{255, 0, 0});
  CHECK(at(shown(DisplayMode::flicker, true), 0, 0) == Rgb{0, 255, 0});
  CHECK(at(shown(DisplayMode::classes), 0, 0) == Rgb{0, 0, 255});
  CHECK(at(shown(DisplayMode::difference), 0, 0) == Rgb{255, 255, 255});  // a difference of 1
  const Picture side = shown(DisplayMode::side_by_side);
  CHECK(side.width == 8);
  CHECK(at(side, 3, 1) == Rgb{255, 0, 0});
  CHECK(at(side, 4, 1) == Rgb{0, 255, 0});
}

TEST_CASE("split shows a left of the line and b right of it") {
  for (const auto& [split, columns] : {std::pair(0.0f, 0u), {0.25f, 1u}, {0.5f, 2u}, {1.0f, 4u}}) {
    const Picture picture = compose(red, green, nullptr, {.mode = DisplayMode::split, .split = split});
    CHECK(picture.width == 4);
    for (std::uint32_t x = 0; x < 4; ++x) CHECK(at(picture, x, 1) == (x < columns ? Rgb{255, 0, 0} : Rgb{0, 255, 0}));
  }
}

TEST_CASE("a picture in the window has the bytes of its PNG") {
  const test::ScratchFolder folder;
  pathtracer::Image image{16, 16, {}};
  for (int i = 0; i < 256; ++i) image.pixels.emplace_back(float(i) / 200, float(i) / 3000, 1 - float(i) / 255);
  const pathtracer::Tone tone{.curve = pathtracer::ToneCurve::srgb, .exposure = 0.5};
  pathtracer::write_image(folder.path() / "x.png", image, {}, tone);
  // Eight bits, decoded and encoded once more, are the same eight bits.
  CHECK(displayed(pathtracer::read_image(folder.path() / "x.png"), {}) == displayed(image, tone));
}

TEST_CASE("pixels count as different by their bits") {
  pathtracer::Image other = red;
  CHECK(count_differing(red, other) == 0);
  other.pixels[3].y = -0.0f;
  other.pixels[5].x = std::bit_cast<float>(std::bit_cast<std::uint32_t>(1.0f) + 1);
  CHECK(count_differing(red, other) == 2);
  other.pixels[0].x = std::numeric_limits<float>::quiet_NaN();
  CHECK(count_differing(other, other) == 0);
}

TEST_CASE("a headlight shows a surface that faces the camera in its colour, from either side") {
  CHECK(headlight({0.5f, 0.25f, 1}, {0, 0, 1}, {0, 0, -1}) == glm::vec3(0.5f, 0.25f, 1));
  CHECK(headlight({0.5f, 0.25f, 1}, {0, 0, 1}, {0, 0, 1}) == glm::vec3(0.5f, 0.25f, 1));
  CHECK(headlight({1, 1, 1}, {0, 0, 1}, {1, 0, 0}).x < 0.2f);
}

}  // namespace
}  // namespace tandem::view
