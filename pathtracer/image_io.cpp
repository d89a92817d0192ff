#include "pathtracer/image_io.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <vector>

#include "pathtracer/atomic_file.hpp"
#include "pathtracer/error.hpp"
#include "pathtracer/image_codec.hpp"
#include "pathtracer/srgb.hpp"

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
  throw Error("cannot write '" + path.string() + "': the name of an image ends in .exr or .png");
}

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

}  // namespace

void check_image_path(const std::filesystem::path& path) {
  format_of(path);
  const AtomicFile probe(path);
}

void write_image(const std::filesystem::path& path, const Image& image, const ImageMetadata& metadata,
                 const Tone& tone) {
  const Format format = format_of(path);
  const auto fail = [&](const std::string& why) {
    return Error("cannot write '" + path.string() + "': " + first_line(why));
  };
  if (image.pixels.empty()) throw fail("the image is empty");
  AtomicFile target(path);
  ImageAttributes attributes;
  for (const auto& [key, value] : metadata) attributes.emplace(std::string(metadata_prefix) + key, value);
  std::vector<std::byte> file;
  try {
    if (format == Format::exr) {
      file = encode_exr(image.width, image.height, image.pixels, attributes);
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
