#include "pathtracer/image/image_io.hpp"

#include <algorithm>
#include <bit>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

#include "base/atomic_file.hpp"
#include "base/error.hpp"
#include "base/input_file.hpp"
#include "base/printable.hpp"
#include "base/srgb.hpp"
#include "pathtracer/image/image_codec.hpp"

namespace tandem::pathtracer {
namespace {

constexpr std::string_view metadata_prefix = "tandem:";

enum class Format { exr, png };

Format format_of(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (extension == ".exr") return Format::exr;
  if (extension == ".png") return Format::png;
  throw Error("cannot write '" + path.string() + "': the file name must end in .exr or .png");
}

std::string first_line(const std::string& text) { return shortened(text.substr(0, text.find('\n')), 300); }

Error write_error(const std::filesystem::path& path, const std::string& why) {
  return Error("cannot write '" + path.string() + "': " + first_line(why));
}

}  // namespace

std::vector<ImageChannel> color_channels(const Image& image) {
  std::vector<ImageChannel> channels;
  for (int component = 0; component < 3; ++component) {
    ImageChannel channel{.name = std::string(1, "RGB"[component]), .is_integer = false, .words = {}};
    for (const glm::vec3& pixel : image.pixels) channel.words.push_back(std::bit_cast<std::uint32_t>(pixel[component]));
    channels.push_back(std::move(channel));
  }
  return channels;
}

void check_image_path(const std::filesystem::path& path) {
  format_of(path);
  try {
    require_image_codec();
  } catch (const Error& error) {
    throw write_error(path, error.what());
  }
  const AtomicFile probe(path);
}

void write_image(const std::filesystem::path& path, const Image& image, const ImageMetadata& metadata, const Tone& tone,
                 std::span<const ImageChannel> layers) {
  const Format format = format_of(path);
  const auto fail = [&](const std::string& why) { return write_error(path, why); };
  if (image.pixels.empty()) throw fail("the image is empty");
  if (format != Format::exr && !layers.empty()) throw fail("only an .exr holds layers");
  AtomicFile target(path);
  ImageAttributes attributes;
  for (const auto& [key, value] : metadata) attributes.emplace(std::string(metadata_prefix) + key, value);
  std::vector<std::byte> file;
  try {
    if (format == Format::exr) {
      std::vector<ImageChannel> channels = color_channels(image);
      channels.insert(channels.end(), layers.begin(), layers.end());
      file = encode_exr(image.width, image.height, channels, attributes);
    } else {
      std::vector<std::uint8_t> encoded;
      encoded.reserve(3 * image.pixels.size());
      for (const glm::vec3& pixel : image.pixels) {
        const glm::vec3 shown = tone_mapped(pixel, tone);
        for (const float value : {shown.x, shown.y, shown.z})
          encoded.push_back(static_cast<std::uint8_t>(std::lround(255 * value)));
      }
      file = encode_png(image.width, image.height, encoded, attributes);
    }
  } catch (const Error& error) {
    throw fail(error.what());
  }
  target.write(file);
  target.commit();
}

Image read_image(const std::filesystem::path& path, ImageMetadata* metadata) {
  const auto fail = [&](const std::string& why) {
    return Error("cannot read '" + path.string() + "': " + first_line(why));
  };
  check_input(path);
  DecodedImage decoded;
  try {
    decoded = decode_image(path);
  } catch (const Error& error) {
    throw fail(error.what());
  }
  if (decoded.channels < 3) throw fail("it has fewer than three channels");
  Image image{decoded.width, decoded.height, {}};
  image.pixels.resize(std::size_t{image.width} * image.height);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    const float* values = decoded.values.data() + i * decoded.channels;
    for (int channel = 0; channel < 3; ++channel)
      image.pixels[i][channel] = decoded.is_png ? srgb_decode(values[channel]) : values[channel];
  }
  if (metadata != nullptr) {
    metadata->clear();
    for (const auto& [name, value] : decoded.attributes)
      if (name.starts_with(metadata_prefix)) metadata->emplace(name.substr(metadata_prefix.size()), value);
  }
  return image;
}

}  // namespace tandem::pathtracer
