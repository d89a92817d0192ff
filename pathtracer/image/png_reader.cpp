#include "pathtracer/image/png_reader.hpp"

#include <cstring>
#include <vector>

#include <png.h>

#include "base/error.hpp"
#include "pathtracer/image/image_limits.hpp"

namespace tandem::pathtracer {
namespace {

/// libpng reports an error by a function that must not return; the reason travels in an exception through C code, which
/// libpng is compiled to allow.
[[noreturn]] void throw_png_error(png_structp, png_const_charp message) { throw Error(message); }
void ignore_png_warning(png_structp, png_const_charp) {}

struct PngReader {
  png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, &throw_png_error, &ignore_png_warning);
  png_infop info = png != nullptr ? png_create_info_struct(png) : nullptr;

  PngReader() = default;
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;
  ~PngReader() { png_destroy_read_struct(&png, &info, nullptr); }
};

void take_bytes(png_structp png, png_bytep bytes, std::size_t count) {
  auto& rest = *static_cast<std::span<const std::byte>*>(png_get_io_ptr(png));
  if (count > rest.size()) png_error(png, "the file ends too early");
  std::memcpy(bytes, rest.data(), count);
  rest = rest.subspan(count);
}

}  // namespace

bool is_png(std::span<const std::byte> file) {
  constexpr std::size_t signature_size = 8;
  return file.size() >= signature_size &&
         png_sig_cmp(reinterpret_cast<png_const_bytep>(file.data()), 0, signature_size) == 0;
}

DecodedImage decode_png(std::span<const std::byte> file) {
  const std::size_t file_size = file.size();
  PngReader reader;
  if (reader.info == nullptr) throw Error("libpng has no memory");
  png_set_read_fn(reader.png, &file, &take_bytes);
  png_read_info(reader.png, reader.info);
  png_set_expand(reader.png);  // palettes and few bits become 8 bits, transparent colours alpha
  png_set_swap(reader.png);    // 16 bits in this machine's order
  png_set_interlace_handling(reader.png);
  png_read_update_info(reader.png, reader.info);
  DecodedImage image;
  image.width = png_get_image_width(reader.png, reader.info);
  image.height = png_get_image_height(reader.png, reader.info);
  image.channels = png_get_channels(reader.png, reader.info);
  image.is_png = true;
  check_image_size(image.width, image.height, image.channels, file_size);
  const bool wide = png_get_bit_depth(reader.png, reader.info) == 16;
  image.type = wide ? StoredType::unorm16 : StoredType::unorm8;
  const std::size_t row_bytes = png_get_rowbytes(reader.png, reader.info);
  std::vector<png_byte> bytes(row_bytes * image.height);
  std::vector<png_bytep> rows;
  for (std::size_t y = 0; y < image.height; ++y) rows.push_back(bytes.data() + y * row_bytes);
  png_read_image(reader.png, rows.data());
  png_read_end(reader.png, reader.info);
  image.values.reserve(std::size_t{image.width} * image.height * image.channels);
  for (std::size_t i = 0; i < bytes.size(); i += wide ? 2 : 1) {
    std::uint16_t value = bytes[i];
    if (wide) std::memcpy(&value, bytes.data() + i, sizeof(value));
    image.values.push_back(static_cast<float>(value) * (wide ? 1.0f / 65535.0f : 1.0f / 255.0f));
  }
  png_textp texts = nullptr;
  const int count = png_get_text(reader.png, reader.info, &texts, nullptr);
  for (int i = 0; i < count; ++i) image.attributes.emplace(texts[i].key, texts[i].text);
  return image;
}

}  // namespace tandem::pathtracer
