#include "pathtracer/scene/texel.hpp"

#include <cstring>
#include <vector>

#include <doctest/doctest.h>

#include "pathtracer/scene/scene.hpp"

using namespace tandem::pathtracer;

namespace {

/// An image one texel high.
template <typename T>
TextureImage image_of(TexelFormat format, std::uint32_t width, const std::vector<T>& values) {
  TextureImage image{.name = "test", .format = format, .width = width, .height = 1, .texels = {}};
  image.texels.resize(values.size() * sizeof(T));
  std::memcpy(image.texels.data(), values.data(), image.texels.size());
  return image;
}

using Bytes = std::vector<std::uint8_t>;
using Words = std::vector<std::uint16_t>;
using Floats = std::vector<float>;

}  // namespace

TEST_CASE("Texels of every format are read as the shader reads them") {
  const Bytes bytes = {1, 2, 3, 4, 0, 255, 188, 51};
  CHECK(texel_at(image_of(TexelFormat::unorm8, 2, bytes), 1) == glm::vec4(0, 1, 188 / 255.0f, 0.2f));
  const glm::vec4 srgb = texel_at(image_of(TexelFormat::srgb8, 2, bytes), 1);
  CHECK(srgb.x == 0);
  CHECK(srgb.y == 1);
  CHECK(srgb.z == doctest::Approx(0.5029).epsilon(1e-4));  // IEC 61966-2-1 of 188 / 255
  CHECK(srgb.w == 0.2f);
  CHECK(texel_at(image_of(TexelFormat::unorm16, 1, Words{0, 65535, 13107, 6553}), 0) ==
        glm::vec4(0, 1, 0.2f, 6553 / 65535.0f));
  CHECK(texel_at(image_of(TexelFormat::half, 1, Words{0x3c00, 0x4000, 0x3555, 0x7bff}), 0) ==
        glm::vec4(1, 2, 0.33325195f, 65504));
  CHECK(texel_at(image_of(TexelFormat::float32, 2, Floats{0, 0, 0, 0, 1, 1e9f, 3, 0.5f}), 1) ==
        glm::vec4(1, 1e9f, 3, 0.5f));
  CHECK(texel_at(image_of(TexelFormat::single_unorm8, 8, bytes), 5) == glm::vec4(1));
}

TEST_CASE("The mean colour of a texture is that of its texels, or of its pigments") {
  Scene scene;
  const std::uint32_t index =
      add_texture(scene, image_of(TexelFormat::float32, 2, Floats{1, 0, 0.5f, 1, 3, 2, 0.5f, 1}));
  scene.textures[index].gpu.color_a = glm::vec3(2, 1, 1);
  CHECK(mean_color(scene, scene.textures[index]) == glm::vec3(4, 1, 0.5f));
  Texture checker{.gpu = {.kind = TextureKind::checker, .color_a = glm::vec3(1), .color_b = glm::vec3(0, 0, 1)}};
  CHECK(mean_color(scene, checker) == glm::vec3(0.5f, 0.5f, 1));
  checker.gpu.kind = TextureKind::uniform;
  CHECK(mean_color(scene, checker) == glm::vec3(1));
}
