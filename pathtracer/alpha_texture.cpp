#include "pathtracer/alpha_texture.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

#include <fmt/format.h>

#include "pathtracer/error.hpp"
#include "pathtracer/image_codec.hpp"
#include "pathtracer/lights.hpp"

namespace tandem::pathtracer {
namespace {

/// The most pixels along a side; a file that claims more is broken.
constexpr std::uint32_t largest_side = 1u << 15;

std::uint8_t to_8bit(float value) {
  return value > 0 ? static_cast<std::uint8_t>(std::lround(255 * std::min(value, 1.0f))) : std::uint8_t{0};
}

}  // namespace

TextureImage load_alpha_texture(const std::filesystem::path& path) {
  const auto fail = [&](const std::string& why) {
    return Error(fmt::format("cannot read the texture '{}': {}", path.string(), why.substr(0, why.find('\n'))));
  };
  DecodedImage image;
  try {
    image = decode_image(path);
  } catch (const Error& error) {
    throw fail(error.what());
  }
  if (image.width < 1 || image.height < 1 || image.width > largest_side || image.height > largest_side)
    throw fail(fmt::format("a size of {}x{} is not between 1 and {}", image.width, image.height, largest_side));
  TextureImage texture{.name = path.filename().string(),
                       .format = TexelFormat::single_unorm8,
                       .width = image.width,
                       .height = image.height,
                       .texels = {}};
  const std::size_t count = std::size_t{image.width} * image.height;
  texture.texels.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const float* values = image.values.data() + i * image.channels;
    float alpha = values[0];
    if (image.channels == 2 || image.channels == 4)
      alpha = values[image.channels - 1];
    else if (image.channels == 3)
      alpha = static_cast<float>(luminance(glm::vec3(values[0], values[1], values[2])));
    texture.texels.push_back(std::byte{to_8bit(alpha)});
  }
  return texture;
}

}  // namespace tandem::pathtracer
