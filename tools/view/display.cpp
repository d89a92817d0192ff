#include "tools/view/display.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "compare/image/difference.hpp"

namespace tandem::view {
namespace {

constexpr Named<DisplayMode> mode_names[] = {
    {DisplayMode::a, "a"},
    {DisplayMode::b, "b"},
    {DisplayMode::split, "split"},
    {DisplayMode::side_by_side, "side by side"},
    {DisplayMode::flicker, "flicker"},
    {DisplayMode::difference, "difference"},
    {DisplayMode::classes, "classes"},
};

void add(std::vector<std::uint8_t>& bytes, const glm::vec3& pixel, const pathtracer::Tone& tone) {
  const glm::vec3 shown = pathtracer::tone_mapped(pixel, tone);
  for (const float value : {shown.x, shown.y, shown.z})
    bytes.push_back(static_cast<std::uint8_t>(std::lround(value * 255.0f)));
  bytes.push_back(255);
}

}  // namespace

std::span<const Named<DisplayMode>> display_mode_names() { return mode_names; }

Picture displayed(const pathtracer::Image& image, const pathtracer::Tone& tone) {
  Picture picture{image.width, image.height, {}};
  picture.bytes.reserve(image.pixels.size() * 4);
  for (const glm::vec3& pixel : image.pixels) add(picture.bytes, pixel, tone);
  return picture;
}

Picture compose(const pathtracer::Image& a, const pathtracer::Image& b, const pathtracer::Image* classes,
                const Display& display) {
  switch (display.mode) {
    case DisplayMode::a:
      return displayed(a, display.tone);
    case DisplayMode::b:
      return displayed(b, display.tone);
    case DisplayMode::flicker:
      return displayed(display.flicker_b ? b : a, display.tone);
    case DisplayMode::difference:
      return displayed(compare::heat_map(a, b), {});
    case DisplayMode::classes: {
      if (classes != nullptr) return displayed(*classes, {});
      return displayed({a.width, a.height, std::vector(a.pixels.size(), glm::vec3(0))}, {});
    }
    default:
      break;
  }
  const bool split = display.mode == DisplayMode::split;
  const auto line =
      static_cast<std::uint32_t>(std::lround(std::clamp(display.split, 0.0f, 1.0f) * static_cast<float>(a.width)));
  Picture picture{split ? a.width : a.width + b.width, a.height, {}};
  picture.bytes.reserve(std::size_t{picture.width} * picture.height * 4);
  for (std::uint32_t y = 0; y < a.height; ++y) {
    for (std::uint32_t x = 0; x < a.width; ++x)
      add(picture.bytes, split && x >= line ? b.at(x, y) : a.at(x, y), display.tone);
    for (std::uint32_t x = 0; !split && x < b.width; ++x) add(picture.bytes, b.at(x, y), display.tone);
  }
  return picture;
}

std::uint64_t count_differing(const pathtracer::Image& a, const pathtracer::Image& b) {
  std::uint64_t count = 0;
  compare::differing_pixels(a, b, 0, count);
  return count;
}

}  // namespace tandem::view
