// The module that image_codec_on_demand.cpp opens.
#include <array>
#include <exception>
#include <memory>
#include <new>
#include <string>
#include <string_view>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include "base/error.hpp"
#include "base/input_file.hpp"
#include "pathtracer/image/image_codec_module.hpp"
#include "pathtracer/image/image_limits.hpp"
#include "pathtracer/image/png_reader.hpp"

namespace tandem::pathtracer {
namespace {

/// @param pixels in the types of the channels
std::vector<std::byte> encode(const char* format, OIIO::ImageSpec spec, const void* pixels, const char* color_space,
                              const ImageAttributes& attributes) {
  const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(format);
  if (!output) throw Error(OIIO::geterror());
  spec.attribute("oiio:ColorSpace", color_space);
  for (const auto& [key, value] : attributes) spec.attribute(key, value);
  // Into memory first: OpenImageIO's own files do not say when a full disk took only half of one.
  std::vector<unsigned char> file;
  OIIO::Filesystem::IOVecOutput memory(file);
  if (!output->set_ioproxy(&memory) || !output->open(std::string("picture.") + format, spec) ||
      !output->write_image(OIIO::TypeDesc::UNKNOWN, pixels) || !output->close())
    throw Error(output->geterror());
  const std::span<const std::byte> bytes = std::as_bytes(std::span(file));
  return {bytes.begin(), bytes.end()};
}

/// Pixels as the file has them: OpenImageIO multiplies colours by alpha unless told not to.
OIIO::ImageSpec reading_config() {
  OIIO::ImageSpec config;
  config.attribute("oiio:UnassociatedAlpha", 1);
  return config;
}

/// OpenImageIO knows a format by the name of its file; this is one for bytes that have none.
std::string name_of_format(std::span<const std::byte> file) {
  using namespace std::string_view_literals;
  const std::string_view bytes(reinterpret_cast<const char*>(file.data()), file.size());
  if (bytes.starts_with("\x89PNG"sv)) return "image.png";
  if (bytes.starts_with("\xff\xd8\xff"sv)) return "image.jpg";
  if (bytes.starts_with("\x76\x2f\x31\x01"sv)) return "image.exr";
  if (bytes.starts_with("#?"sv)) return "image.hdr";
  throw Error("it is neither a PNG, a JPEG, an OpenEXR nor a Radiance file");
}

StoredType stored_type(OIIO::TypeDesc type) {
  if (type == OIIO::TypeDesc::UINT8) return StoredType::unorm8;
  if (type == OIIO::TypeDesc::UINT16) return StoredType::unorm16;
  return type == OIIO::TypeDesc::HALF ? StoredType::half : StoredType::float32;
}

DecodedImage decode(OIIO::ImageInput& input, std::uint64_t file_bytes) {
  const OIIO::ImageSpec spec = input.spec();
  if (spec.width < 1 || spec.height < 1 || spec.nchannels < 1) throw Error("it is empty");
  check_image_size(static_cast<std::uint64_t>(spec.width), static_cast<std::uint64_t>(spec.height),
                   static_cast<std::uint64_t>(spec.nchannels), file_bytes);
  DecodedImage image{.width = static_cast<std::uint32_t>(spec.width),
                     .height = static_cast<std::uint32_t>(spec.height),
                     .channels = static_cast<std::uint32_t>(spec.nchannels),
                     .values = {},
                     .type = stored_type(spec.format),
                     .is_png = false,
                     .attributes = {}};
  image.values.resize(std::size_t{image.width} * image.height * image.channels);
  if (!input.read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, image.values.data()))
    throw Error(input.geterror());
  for (const OIIO::ParamValue& attribute : spec.extra_attribs)
    if (attribute.type() == OIIO::TypeDesc::STRING)
      image.attributes.emplace(attribute.name().string(), attribute.get_string());
  return image;
}

std::vector<std::byte> exr_file(std::uint32_t width, std::uint32_t height, std::span<const ImageChannel> channels,
                                const ImageAttributes& attributes) {
  OIIO::ImageSpec spec(static_cast<int>(width), static_cast<int>(height), static_cast<int>(channels.size()),
                       OIIO::TypeDesc::FLOAT);
  spec.channelnames.clear();
  for (const ImageChannel& channel : channels) {
    spec.channelnames.push_back(channel.name);
    spec.channelformats.push_back(channel.is_integer ? OIIO::TypeDesc::UINT32 : OIIO::TypeDesc::FLOAT);
  }
  std::vector<std::uint32_t> pixels(std::size_t{width} * height * channels.size());
  for (std::size_t i = 0; i < pixels.size(); ++i) pixels[i] = channels[i % channels.size()].words[i / channels.size()];
  return encode("exr", spec, pixels.data(), "Linear", attributes);
}

std::vector<std::byte> png_file(std::uint32_t width, std::uint32_t height, std::span<const std::uint8_t> rgb,
                                const ImageAttributes& attributes) {
  const OIIO::ImageSpec spec(static_cast<int>(width), static_cast<int>(height), 3, OIIO::TypeDesc::UINT8);
  return encode("png", spec, rgb.data(), "sRGB", attributes);
}

/// What a reader throws of its own are accidents inside, such as a list of more elements than there can be.
template <typename Decode>
DecodedImage guarded(const Decode& decode) {
  try {
    return decode();
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw Error("it does not fit into memory");
  } catch (const std::exception&) {
    throw Error("its contents are not those of a picture");
  }
}

std::string reason(const std::string& reported) {
  return reported.empty() ? "its contents are not those of a picture" : reported;
}

DecodedImage decode_bytes(std::span<const std::byte> file) {
  if (is_png(file)) return guarded([&] { return decode_png(file); });
  const std::string name = name_of_format(file);
  return guarded([&] {
    OIIO::Filesystem::IOMemReader memory(const_cast<std::byte*>(file.data()), file.size());  // which only reads
    OIIO::Filesystem::IOProxy* proxy =
        &memory;  // named twice: some readers forget the argument where there is a config
    OIIO::ImageSpec config = reading_config();
    config.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
    const std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::open(name, &config, proxy);
    if (!input) throw Error(reason(OIIO::geterror()));
    return decode(*input, file.size());
  });
}

DecodedImage decode_path(const std::filesystem::path& path) {
  InputFile file(path);
  std::array<char, 8> signature{};
  const std::size_t count = file.read(signature);
  if (is_png(std::as_bytes(std::span(signature)).first(count))) {
    const std::string bytes = read_bytes(path, most_image_file_bytes);
    return decode_bytes(std::as_bytes(std::span(bytes)));
  }
  return guarded([&] {
    const OIIO::ImageSpec config = reading_config();
    const std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::open(path.string(), &config);
    if (!input) throw Error(reason(OIIO::geterror()));
    return decode(*input, file.size());
  });
}

}  // namespace
}  // namespace tandem::pathtracer

extern "C" __attribute__((visibility("default"))) const tandem::pathtracer::ImageCodecModule* tandem_image_codec() {
  using namespace tandem::pathtracer;
  static constexpr ImageCodecModule module = {.version = TANDEM_VERSION,
                                              .encode_exr = &exr_file,
                                              .encode_png = &png_file,
                                              .decode_path = &decode_path,
                                              .decode_bytes = &decode_bytes};
  return &module;
}
