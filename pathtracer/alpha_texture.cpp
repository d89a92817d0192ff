#include "pathtracer/alpha_texture.hpp"

#include <cmath>
#include <memory>
#include <string>

#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include "pathtracer/error.hpp"
#include "pathtracer/lights.hpp"

namespace tandem::pathtracer {
namespace {

/// The most pixels along a side; a file that claims more is broken.
constexpr int largest_side = 1 << 15;

}  // namespace

AlphaTexture load_alpha_texture(const std::filesystem::path& path) {
  const auto fail = [&](const std::string& why) {
    return Error(fmt::format("cannot read the texture '{}': {}", path.string(), why.substr(0, why.find('\n'))));
  };
  const std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::open(path.string());
  if (!input) throw fail(OIIO::geterror());
  const OIIO::ImageSpec spec = input->spec();
  if (spec.width < 1 || spec.height < 1 || spec.width > largest_side || spec.height > largest_side)
    throw fail(fmt::format("a size of {}x{} is not between 1 and {}", spec.width, spec.height, largest_side));
  AlphaTexture texture{
      .width = static_cast<std::uint32_t>(spec.width), .height = static_cast<std::uint32_t>(spec.height), .texels = {}};
  const std::size_t count = std::size_t{texture.width} * texture.height;
  const auto read = [&](int first_channel, int channel_count) {
    std::vector<std::uint8_t> values(count * static_cast<std::size_t>(channel_count));
    if (!input->read_image(0, 0, first_channel, first_channel + channel_count, OIIO::TypeDesc::UINT8, values.data()))
      throw fail(input->geterror());
    return values;
  };
  if (spec.alpha_channel >= 0 || spec.nchannels < 3) {
    texture.texels = read(spec.alpha_channel >= 0 ? spec.alpha_channel : 0, 1);
    return texture;
  }
  const std::vector<std::uint8_t> colors = read(0, 3);
  texture.texels.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const glm::vec3 color(colors[3 * i], colors[3 * i + 1], colors[3 * i + 2]);
    texture.texels.push_back(static_cast<std::uint8_t>(std::lround(luminance(color))));
  }
  return texture;
}

}  // namespace tandem::pathtracer
