#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/named.hpp"
#include "pathtracer/image/image.hpp"
#include "pathtracer/image/tone_map.hpp"

namespace tandem::view {

enum class DisplayMode { a, b, split, side_by_side, flicker, difference, classes };

std::span<const Named<DisplayMode>> display_mode_names();

/// Bytes for a screen, four to a pixel: red, green, blue, 255; row by row from the top left.
struct Picture {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::vector<std::uint8_t> bytes;

  bool operator==(const Picture&) const = default;
};

/// The bytes that write_image gives a PNG.
Picture displayed(const pathtracer::Image& image, const pathtracer::Tone& tone);

struct Display {
  DisplayMode mode = DisplayMode::split;
  float split = 0.5f;       ///< fraction of the picture's width that shows a
  bool flicker_b = false;   ///< which of the two is the turn of `flicker`
  pathtracer::Tone tone{};  ///< of what devices rendered; maps keep their colours
};

/// What the window shows of two pictures of one size. @param classes a class map; null: not known, black
Picture compose(const pathtracer::Image& a, const pathtracer::Image& b, const pathtracer::Image* classes,
                const Display& display);

/// Pixels of which any channel has different bits. Throws Error when the images differ in size.
std::uint64_t count_differing(const pathtracer::Image& a, const pathtracer::Image& b);

}  // namespace tandem::view
