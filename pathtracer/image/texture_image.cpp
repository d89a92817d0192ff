#include "pathtracer/image/texture_image.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include <fmt/format.h>
#include <glm/gtc/packing.hpp>
#include <glm/vec4.hpp>

#include "base/error.hpp"
#include "base/input_file.hpp"
#include "base/printable.hpp"
#include "base/srgb.hpp"
#include "pathtracer/image/image_codec.hpp"
#include "pathtracer/scene/lights.hpp"

namespace tandem::pathtracer {
namespace {

/// The most pixels along a side; a file that claims more is broken.
constexpr std::uint32_t largest_side = 1u << 15;

/// What `decode` returns, whose errors then name the texture.
template <typename Decode>
DecodedImage decoded(const std::string& name, const Decode& decode) {
  const auto fail = [&](const std::string& why) {
    return Error(fmt::format("cannot read the texture '{}': {}", name, shortened(why.substr(0, why.find('\n')), 300)));
  };
  DecodedImage image;
  try {
    image = decode();
  } catch (const Error& error) {
    throw fail(error.what());
  }
  if (image.width < 1 || image.height < 1 || image.width > largest_side || image.height > largest_side)
    throw fail(fmt::format("a size of {}x{} is not between 1 and {}", image.width, image.height, largest_side));
  return image;
}

/// The nearest of the integers from 0 to `largest` that stand for [0, 1].
template <typename Integer>
Integer to_unorm(float value, float largest) {
  return value > 0 ? static_cast<Integer>(std::lround(largest * std::min(value, 1.0f))) : Integer{0};
}

glm::vec4 rgba(const DecodedImage& image, std::size_t pixel) {
  const float* values = image.values.data() + pixel * image.channels;
  switch (image.channels) {
    case 1:
      return {values[0], values[0], values[0], 1};
    case 2:
      return {values[0], values[0], values[0], values[1]};
    case 4:
      return {values[0], values[1], values[2], values[3]};
    default:
      return {values[0], values[1], values[2], 1};
  }
}

/// Less than this counts as 0, so that filtering makes no subnormal numbers, which a device may flush to zero.
constexpr float smallest_value = 1e-20f;

float clean(float value, TextureEncoding encoding) {
  if (!std::isfinite(value) || std::abs(value) < smallest_value) return 0;
  return encoding == TextureEncoding::color ? std::max(value, 0.0f) : value;
}

TexelFormat format_of(const DecodedImage& image, TextureEncoding encoding) {
  switch (image.type) {
    case StoredType::unorm8:
      return encoding == TextureEncoding::color ? TexelFormat::srgb8 : TexelFormat::unorm8;
    case StoredType::unorm16:
      // What 16 bits encode by sRGB needs more of them where it is linear.
      return encoding == TextureEncoding::color ? TexelFormat::float32 : TexelFormat::unorm16;
    case StoredType::half:
      return TexelFormat::half;
    default:
      return TexelFormat::float32;
  }
}

template <typename T>
void append(std::vector<std::byte>& bytes, T value) {
  const auto parts = std::as_bytes(std::span(&value, 1));
  bytes.insert(bytes.end(), parts.begin(), parts.end());
}

void append_texel(std::vector<std::byte>& texels, TexelFormat format, glm::vec4 texel) {
  for (int channel = 0; channel < 4; ++channel) {
    const float value = texel[channel];
    switch (format) {
      case TexelFormat::unorm16:
        append(texels, to_unorm<std::uint16_t>(value, 65535));
        break;
      case TexelFormat::half:
        append(texels, glm::packHalf1x16(value));
        break;
      case TexelFormat::float32:
        append(texels, value);
        break;
      default:
        append(texels, to_unorm<std::uint8_t>(value, 255));
    }
  }
}

TextureImage texture_image(const DecodedImage& image, const std::string& name, TextureEncoding encoding) {
  TextureImage texture{
      .name = name, .format = format_of(image, encoding), .width = image.width, .height = image.height, .texels = {}};
  const bool decode = encoding == TextureEncoding::color && image.type == StoredType::unorm16;
  const std::size_t count = std::size_t{image.width} * image.height;
  for (std::size_t pixel = 0; pixel < count; ++pixel) {
    glm::vec4 texel = rgba(image, pixel);
    for (int channel = 0; channel < 4; ++channel) {
      texel[channel] = clean(texel[channel], encoding);
      if (decode && channel < 3) texel[channel] = srgb_decode(texel[channel]);
    }
    append_texel(texture.texels, texture.format, texel);
  }
  return texture;
}

}  // namespace

TextureImage load_texture_image(const std::filesystem::path& path, TextureEncoding encoding) {
  check_input(path);
  const DecodedImage image = decoded(path.string(), [&] { return decode_image(path); });
  return texture_image(image, path.filename().string(), encoding);
}

TextureImage decode_texture_image(std::span<const std::byte> file, const std::string& name, TextureEncoding encoding) {
  return texture_image(decoded(name, [&] { return decode_image(file); }), name, encoding);
}

TextureImage load_alpha_texture(const std::filesystem::path& path) {
  check_input(path);
  const DecodedImage image = decoded(path.string(), [&] { return decode_image(path); });
  TextureImage texture{.name = path.filename().string(),
                       .format = TexelFormat::single_unorm8,
                       .width = image.width,
                       .height = image.height,
                       .texels = {}};
  const std::size_t count = std::size_t{image.width} * image.height;
  texture.texels.reserve(count);
  for (std::size_t pixel = 0; pixel < count; ++pixel) {
    const glm::vec4 texel = rgba(image, pixel);
    float alpha = texel.x;
    if (image.channels == 2 || image.channels == 4)
      alpha = texel.w;
    else if (image.channels >= 3)
      alpha = static_cast<float>(luminance(glm::vec3(texel)));
    texture.texels.push_back(std::byte{to_unorm<std::uint8_t>(alpha, 255)});
  }
  return texture;
}

}  // namespace tandem::pathtracer
