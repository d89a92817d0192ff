#include "pathtracer/image_io.hpp"

#include <algorithm>
#include <cctype>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include "pathtracer/atomic_file.hpp"
#include "pathtracer/error.hpp"
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

void write_image(const std::filesystem::path& path, const Image& image, const ImageMetadata& metadata) {
  const Format format = format_of(path);
  if (image.pixels.empty()) throw Error("cannot write '" + path.string() + "': the image is empty");
  AtomicFile target(path);
  const auto fail = [&](const std::string& why) {
    return Error("cannot write '" + path.string() + "': " + first_line(why));
  };
  const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(format == Format::exr ? "exr" : "png");
  if (!output) throw fail(OIIO::geterror());

  OIIO::ImageSpec spec(static_cast<int>(image.width), static_cast<int>(image.height), 3,
                       format == Format::exr ? OIIO::TypeDesc::FLOAT : OIIO::TypeDesc::UINT8);
  spec.attribute("oiio:ColorSpace", format == Format::exr ? "Linear" : "sRGB");
  for (const auto& [key, value] : metadata) spec.attribute(std::string(metadata_prefix) + key, value);
  // Into memory first: OpenImageIO's own files do not say when a full disk took only half of one.
  std::vector<unsigned char> file;
  OIIO::Filesystem::IOVecOutput memory(file);
  if (!output->set_ioproxy(&memory) || !output->open(path.filename().string(), spec)) throw fail(output->geterror());
  bool written = false;
  if (format == Format::exr) {
    written = output->write_image(OIIO::TypeDesc::FLOAT, image.pixels.data());
  } else {
    std::vector<std::uint8_t> encoded;
    encoded.reserve(3 * image.pixels.size());
    for (const glm::vec3& pixel : image.pixels)
      for (const float value : {pixel.x, pixel.y, pixel.z}) encoded.push_back(srgb_encode_8bit(value));
    written = output->write_image(OIIO::TypeDesc::UINT8, encoded.data());
  }
  if (!written || !output->close()) throw fail(output->geterror());
  target.write(std::as_bytes(std::span(file)));
  target.commit();
}

Image read_image(const std::filesystem::path& path, ImageMetadata* metadata) {
  const auto fail = [&](const std::string& why) {
    return Error("cannot read '" + path.string() + "': " + first_line(why));
  };
  const std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::open(path.string());
  if (!input) throw fail(OIIO::geterror());
  const OIIO::ImageSpec spec = input->spec();
  if (spec.nchannels < 3) throw fail("it has fewer than three channels");
  Image image{static_cast<std::uint32_t>(spec.width), static_cast<std::uint32_t>(spec.height), {}};
  image.pixels.resize(std::size_t{image.width} * image.height);
  if (!input->read_image(0, 0, 0, 3, OIIO::TypeDesc::FLOAT, image.pixels.data())) throw fail(input->geterror());
  if (std::string_view(input->format_name()) == "png")
    for (glm::vec3& pixel : image.pixels)
      for (int channel = 0; channel < 3; ++channel) pixel[channel] = srgb_decode(pixel[channel]);
  if (metadata != nullptr) {
    metadata->clear();
    for (const OIIO::ParamValue& attribute : spec.extra_attribs) {
      const std::string name = attribute.name().string();
      if (name.starts_with(metadata_prefix))
        metadata->emplace(name.substr(metadata_prefix.size()), attribute.get_string());
    }
  }
  return image;
}

}  // namespace tandem::pathtracer
