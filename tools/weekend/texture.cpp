#include "tools/weekend/texture.hpp"

#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "base/error.hpp"
#include "pathtracer/scene/texel.hpp"

namespace tandem::weekend {
namespace {

using pathtracer::GpuTexture;

glm::dvec2 own_coordinates(const GpuTexture& texture, const glm::dvec2& uv) {
  const glm::dvec3 u = texture.u_row;
  const glm::dvec3 v = texture.v_row;
  return {u.x * uv.x + u.y * uv.y + u.z, v.x * uv.x + v.y * uv.y + v.z};
}

class Uniform final : public Texture {
 public:
  explicit Uniform(const GpuTexture& texture) : color_(glm::dvec3(texture.color_a), texture.alpha_a) {}
  glm::dvec4 value(const glm::dvec2&) const override { return color_; }

 private:
  glm::dvec4 color_;
};

class Checker final : public Texture {
 public:
  explicit Checker(const GpuTexture& texture) : texture_(texture) {}
  glm::dvec4 value(const glm::dvec2& uv) const override {
    const glm::dvec2 place = own_coordinates(texture_, uv) * double{texture_.scale};
    const double squares = std::floor(place.x) + std::floor(place.y);
    const bool second = std::fmod(std::abs(squares), 2.0) == 1.0;
    return second ? glm::dvec4(glm::dvec3(texture_.color_b), texture_.alpha_b)
                  : glm::dvec4(glm::dvec3(texture_.color_a), texture_.alpha_a);
  }

 private:
  GpuTexture texture_;
};

/// The texel that a whole coordinate means, which may lie beside the image.
std::int64_t addressed(std::int64_t texel, std::int64_t count, pathtracer::TextureAddress address) {
  if (address == pathtracer::TextureAddress::clamp) return std::min(std::max(texel, std::int64_t{0}), count - 1);
  const std::int64_t period = address == pathtracer::TextureAddress::mirror ? 2 * count : count;
  const std::int64_t folded = ((texel % period) + period) % period;
  return folded < count ? folded : period - 1 - folded;
}

class ImageTexture final : public Texture {
 public:
  ImageTexture(const GpuTexture& texture, const pathtracer::TextureImage& image)
      : texture_(texture), width_(image.width), height_(image.height) {
    texels_.reserve(std::size_t{image.width} * image.height);
    for (std::size_t i = 0; i < std::size_t{image.width} * image.height; ++i)
      texels_.emplace_back(pathtracer::texel_at(image, i));
  }

  glm::dvec4 value(const glm::dvec2& uv) const override {
    const glm::dvec2 place = own_coordinates(texture_, uv) * glm::dvec2(width_, height_);
    const glm::dvec4 factor(glm::dvec3(texture_.color_a), texture_.alpha_a);
    if (texture_.filter == pathtracer::TextureFilter::nearest)
      return texel(std::floor(place.x), std::floor(place.y)) * factor;
    const glm::dvec2 corner(std::floor(place.x - 0.5), std::floor(place.y - 0.5));
    const glm::dvec2 part = place - 0.5 - corner;
    const glm::dvec4 lower = texel(corner.x, corner.y) * (1 - part.x) + texel(corner.x + 1, corner.y) * part.x;
    const glm::dvec4 upper = texel(corner.x, corner.y + 1) * (1 - part.x) + texel(corner.x + 1, corner.y + 1) * part.x;
    return (lower * (1 - part.y) + upper * part.y) * factor;
  }

 private:
  /// Rows are counted from below here, from above in the file.
  glm::dvec4 texel(double column, double row) const {
    const auto address_u = static_cast<pathtracer::TextureAddress>(texture_.address & 0xffu);
    const auto address_v = static_cast<pathtracer::TextureAddress>(texture_.address >> 8);
    const std::int64_t x = addressed(static_cast<std::int64_t>(column), width_, address_u);
    const std::int64_t y = addressed(static_cast<std::int64_t>(row), height_, address_v);
    return texels_[static_cast<std::size_t>((height_ - 1 - y) * width_ + x)];
  }

  GpuTexture texture_;
  std::int64_t width_, height_;
  std::vector<glm::dvec4> texels_;
};

}  // namespace

std::unique_ptr<Texture> make_texture(const pathtracer::Scene& scene, std::uint32_t index) {
  const pathtracer::Texture& texture = scene.textures[index];
  if (texture.gpu.coordinates != 0) throw Error("the baseline reads one set of texture coordinates only");
  switch (texture.gpu.kind) {
    case pathtracer::TextureKind::uniform:
      return std::make_unique<Uniform>(texture.gpu);
    case pathtracer::TextureKind::checker:
      return std::make_unique<Checker>(texture.gpu);
    case pathtracer::TextureKind::image:
      return std::make_unique<ImageTexture>(texture.gpu, scene.images[texture.image]);
    default:
      throw Error("the baseline has no noise textures");
  }
}

double channel_of(const pathtracer::Texture& texture, const glm::dvec4& value) {
  if (texture.gpu.channel < 4) return value[static_cast<int>(texture.gpu.channel)];
  return 0.2126 * value.x + 0.7152 * value.y + 0.0722 * value.z;
}

}  // namespace tandem::weekend
