#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <string_view>
#include <utility>

#include <png.h>
#include <tinyexr.h>

#include "base/error.hpp"
#include "base/input_file.hpp"
#include "pathtracer/image/image_codec.hpp"
#include "pathtracer/image/image_limits.hpp"
#include "pathtracer/image/png_reader.hpp"

namespace tandem::pathtracer {
namespace {

struct ExrHeader {
  EXRHeader value;

  ExrHeader() { InitEXRHeader(&value); }
  ExrHeader(const ExrHeader&) = delete;
  ExrHeader& operator=(const ExrHeader&) = delete;
  ~ExrHeader() { FreeEXRHeader(&value); }
};

struct ExrImage {
  EXRImage value;

  ExrImage() { InitEXRImage(&value); }
  ExrImage(const ExrImage&) = delete;
  ExrImage& operator=(const ExrImage&) = delete;
  ~ExrImage() { FreeEXRImage(&value); }
};

/// tinyexr's way to say why.
class Reason {
 public:
  Reason() = default;
  Reason(const Reason&) = delete;
  Reason& operator=(const Reason&) = delete;
  ~Reason() { FreeEXRErrorMessage(text_); }

  const char** out() { return &text_; }
  Error error() const { return Error(text_ != nullptr ? text_ : "tinyexr gives no reason"); }

 private:
  const char* text_ = nullptr;
};

constexpr std::array<std::array<const char*, 4>, 5> channel_names = {
    {{}, {"Y"}, {"Y", "A"}, {"R", "G", "B"}, {"R", "G", "B", "A"}}};

/// Positions of the usual channels in the file, as many of them as it has; empty when it has others only.
std::vector<int> usual_channels(const EXRHeader& header) {
  for (std::size_t count = 4; count > 0; --count) {
    std::vector<int> found;
    for (std::size_t wanted = 0; wanted < count; ++wanted)
      for (int i = 0; i < header.num_channels; ++i)
        if (std::string_view(header.channels[i].name) == channel_names[count][wanted]) found.push_back(i);
    if (found.size() == count) return found;
  }
  return {};
}

DecodedImage decode_exr(std::span<const std::byte> file) {
  const auto* bytes = reinterpret_cast<const unsigned char*>(file.data());
  EXRVersion version;
  if (ParseEXRVersionFromMemory(&version, bytes, file.size()) != TINYEXR_SUCCESS)
    throw Error("it is neither a PNG nor an OpenEXR file");
  Reason why;
  ExrHeader header;
  if (ParseEXRHeaderFromMemory(&header.value, &version, bytes, file.size(), why.out()) != TINYEXR_SUCCESS)
    throw why.error();
  const auto is_half = [](int type) { return type == TINYEXR_PIXELTYPE_HALF; };
  const bool all_half =
      std::all_of(header.value.pixel_types, header.value.pixel_types + header.value.num_channels, is_half);
  const EXRBox2i& window = header.value.data_window;
  if (window.max_x < window.min_x || window.max_y < window.min_y) throw Error("its window is empty");
  check_image_size(static_cast<std::uint64_t>(std::int64_t{window.max_x} - window.min_x + 1),
                   static_cast<std::uint64_t>(std::int64_t{window.max_y} - window.min_y + 1),
                   static_cast<std::uint64_t>(header.value.num_channels), file.size());
  for (int i = 0; i < header.value.num_channels; ++i) header.value.requested_pixel_types[i] = TINYEXR_PIXELTYPE_FLOAT;
  ExrImage loaded;
  if (LoadEXRImageFromMemory(&loaded.value, &header.value, bytes, file.size(), why.out()) != TINYEXR_SUCCESS)
    throw why.error();
  if (loaded.value.images == nullptr) throw Error("it is stored in tiles");
  const std::vector<int> channels = usual_channels(header.value);
  if (channels.empty()) throw Error("it has neither R, G, B nor Y channels");
  DecodedImage image{.width = static_cast<std::uint32_t>(loaded.value.width),
                     .height = static_cast<std::uint32_t>(loaded.value.height),
                     .channels = static_cast<std::uint32_t>(channels.size()),
                     .values = {},
                     .type = all_half ? StoredType::half : StoredType::float32,
                     .is_png = false,
                     .attributes = {}};
  const std::size_t pixels = std::size_t{image.width} * image.height;
  image.values.reserve(pixels * channels.size());
  for (std::size_t i = 0; i < pixels; ++i)
    for (const int channel : channels)
      image.values.push_back(reinterpret_cast<const float*>(loaded.value.images[channel])[i]);
  for (int i = 0; i < header.value.num_custom_attributes; ++i) {
    const EXRAttribute& attribute = header.value.custom_attributes[i];
    if (std::string_view(attribute.type) == "string")
      image.attributes.emplace(attribute.name, std::string(reinterpret_cast<const char*>(attribute.value),
                                                           static_cast<std::size_t>(attribute.size)));
  }
  return image;
}

/// As png_reader.cpp does.
[[noreturn]] void throw_png_error(png_structp, png_const_charp message) { throw Error(message); }
void ignore_png_warning(png_structp, png_const_charp) {}

struct PngWriter {
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, &throw_png_error, &ignore_png_warning);
  png_infop info = png != nullptr ? png_create_info_struct(png) : nullptr;

  PngWriter() = default;
  PngWriter(const PngWriter&) = delete;
  PngWriter& operator=(const PngWriter&) = delete;
  ~PngWriter() { png_destroy_write_struct(&png, &info); }
};

void append_bytes(png_structp png, png_bytep bytes, std::size_t count) {
  auto& file = *static_cast<std::vector<std::byte>*>(png_get_io_ptr(png));
  const auto* first = reinterpret_cast<const std::byte*>(bytes);
  file.insert(file.end(), first, first + count);
}

}  // namespace

void require_image_codec() {}  // linked in

std::vector<std::byte> encode_exr(std::uint32_t width, std::uint32_t height, std::span<const ImageChannel> channels,
                                  const ImageAttributes& attributes) {
  // OpenEXR keeps channels apart, and in the order of their names.
  std::vector<ImageChannel> planes(channels.begin(), channels.end());
  std::ranges::sort(planes, {}, &ImageChannel::name);
  std::vector<unsigned char*> plane_pointers;
  std::vector<EXRChannelInfo> infos(planes.size());
  std::vector<int> types;
  for (std::size_t i = 0; i < planes.size(); ++i) {
    planes[i].name.copy(infos[i].name, sizeof(infos[i].name) - 1);
    plane_pointers.push_back(reinterpret_cast<unsigned char*>(planes[i].words.data()));
    types.push_back(planes[i].is_integer ? TINYEXR_PIXELTYPE_UINT : TINYEXR_PIXELTYPE_FLOAT);
  }
  std::vector<EXRAttribute> stored;
  std::vector<std::string> values;  // tinyexr wants pointers to what may be changed
  for (const auto& [key, value] : attributes) {
    EXRAttribute attribute{};
    key.copy(attribute.name, sizeof(attribute.name) - 1);
    std::strcpy(attribute.type, "string");
    attribute.size = static_cast<int>(value.size());
    stored.push_back(attribute);
    values.push_back(value);
  }
  for (std::size_t i = 0; i < stored.size(); ++i) stored[i].value = reinterpret_cast<unsigned char*>(values[i].data());

  // These point into what is above, so nothing of tinyexr's may free them.
  EXRHeader header;
  InitEXRHeader(&header);
  header.num_channels = static_cast<int>(planes.size());
  header.channels = infos.data();
  header.pixel_types = types.data();
  header.requested_pixel_types = types.data();
  header.compression_type = TINYEXR_COMPRESSIONTYPE_ZIP;
  header.num_custom_attributes = static_cast<int>(stored.size());
  header.custom_attributes = stored.data();
  EXRImage image;
  InitEXRImage(&image);
  image.width = static_cast<int>(width);
  image.height = static_cast<int>(height);
  image.num_channels = static_cast<int>(planes.size());
  image.images = plane_pointers.data();
  unsigned char* memory = nullptr;
  Reason why;
  const std::size_t size = SaveEXRImageToMemory(&image, &header, &memory, why.out());
  const std::unique_ptr<unsigned char, decltype(&std::free)> owner(memory, &std::free);
  if (size == 0) throw why.error();
  const std::span<const std::byte> bytes = std::as_bytes(std::span(memory, size));
  return {bytes.begin(), bytes.end()};
}

std::vector<std::byte> encode_png(std::uint32_t width, std::uint32_t height, std::span<const std::uint8_t> rgb,
                                  const ImageAttributes& attributes) {
  PngWriter writer;
  if (writer.info == nullptr) throw Error("libpng has no memory");
  std::vector<std::byte> file;
  png_set_write_fn(writer.png, &file, &append_bytes, nullptr);
  png_set_IHDR(writer.png, writer.info, width, height, 8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_sRGB(writer.png, writer.info, PNG_sRGB_INTENT_PERCEPTUAL);
  std::vector<std::string> keys, values;  // libpng wants pointers to what may be changed
  for (const auto& [key, value] : attributes) {
    keys.push_back(key);
    values.push_back(value);
  }
  std::vector<png_text> texts(keys.size());
  for (std::size_t i = 0; i < texts.size(); ++i) {
    texts[i].compression = PNG_TEXT_COMPRESSION_NONE;
    texts[i].key = keys[i].data();
    texts[i].text = values[i].data();
    texts[i].text_length = values[i].size();
  }
  png_set_text(writer.png, writer.info, texts.data(), static_cast<int>(texts.size()));
  png_write_info(writer.png, writer.info);
  for (std::size_t y = 0; y < height; ++y) png_write_row(writer.png, rgb.data() + y * width * 3);
  png_write_end(writer.png, writer.info);
  return file;
}

DecodedImage decode_image(const std::filesystem::path& path) {
  const std::string file = read_bytes(path, most_image_file_bytes);
  return decode_image(std::as_bytes(std::span(file)));
}

DecodedImage decode_image(std::span<const std::byte> file) {
  return is_png(file) ? decode_png(file) : decode_exr(file);
}

}  // namespace tandem::pathtracer
