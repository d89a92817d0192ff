#include "pathtracer/scene/texel.hpp"

#include <array>
#include <cstdint>
#include <cstring>

#include <glm/gtc/packing.hpp>

#include "base/srgb.hpp"

namespace tandem::pathtracer {
namespace {

/// Four channels of one type.
template <typename T>
std::array<T, 4> channels_at(const TextureImage& image, std::size_t index) {
  std::array<T, 4> channels;
  std::memcpy(channels.data(), image.texels.data() + index * sizeof(channels), sizeof(channels));
  return channels;
}

template <typename T, typename Decode>
glm::vec4 decoded(const std::array<T, 4>& channels, const Decode& decode) {
  return {decode(channels[0]), decode(channels[1]), decode(channels[2]), decode(channels[3])};
}

float from_byte(std::uint8_t value) { return static_cast<float>(value) / 255.0f; }

}  // namespace

glm::vec4 texel_at(const TextureImage& image, std::size_t index) {
  switch (image.format) {
    case TexelFormat::srgb8: {
      const auto channels = channels_at<std::uint8_t>(image, index);
      const glm::vec4 texel = decoded(channels, [](std::uint8_t value) { return srgb_decode(from_byte(value)); });
      return {glm::vec3(texel), from_byte(channels[3])};
    }
    case TexelFormat::unorm16:
      return decoded(channels_at<std::uint16_t>(image, index),
                     [](std::uint16_t value) { return static_cast<float>(value) / 65535.0f; });
    case TexelFormat::half:
      return decoded(channels_at<std::uint16_t>(image, index),
                     [](std::uint16_t value) { return glm::unpackHalf1x16(value); });
    case TexelFormat::float32:
      return decoded(channels_at<float>(image, index), [](float value) { return value; });
    case TexelFormat::single_unorm8:
      return glm::vec4(from_byte(std::to_integer<std::uint8_t>(image.texels[index])));
    default:
      return decoded(channels_at<std::uint8_t>(image, index), from_byte);
  }
}

glm::vec3 mean_color(const Scene& scene, const Texture& texture) {
  switch (texture.gpu.kind) {
    case TextureKind::uniform:
      return texture.gpu.color_a;
    case TextureKind::checker:
    case TextureKind::noise:
      return 0.5f * (texture.gpu.color_a + texture.gpu.color_b);
    default:
      break;
  }
  const TextureImage& image = scene.images[texture.image];
  const std::size_t count = std::size_t{image.width} * image.height;
  glm::dvec3 sum(0);
  for (std::size_t i = 0; i < count; ++i) sum += glm::dvec3(texel_at(image, i));
  return texture.gpu.color_a * glm::vec3(sum / double(count));
}

}  // namespace tandem::pathtracer
