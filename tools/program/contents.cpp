#include "tools/program/contents.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>
#include <string>

#include "base/error.hpp"
#include "base/input_file.hpp"
#include "base/printable.hpp"
#include "pathtracer/image/image_codec.hpp"
#include "pathtracer/image/tone_map.hpp"
#include "program/data/fill.hpp"
#include "program/data/npy.hpp"
#include "program/data/table.hpp"
#include "program/data/texels.hpp"

namespace tandem::tools::program_run {
namespace {

using program::ValueType;

constexpr std::uint64_t most_bytes = std::uint64_t{1} << 32;  // of a resource

std::string extension_of(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::ranges::transform(extension, extension.begin(), [](unsigned char c) { return std::tolower(c); });
  return extension;
}

bool is_raw(const std::filesystem::path& file) { return extension_of(file) == ".bin" || extension_of(file) == ".raw"; }
bool is_table(const std::filesystem::path& file) {
  return extension_of(file) == ".csv" || extension_of(file) == ".txt";
}
bool is_npy(const std::filesystem::path& file) { return extension_of(file) == ".npy"; }

std::vector<std::byte> bytes_of(std::string_view text) {
  const auto bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

/// What a file of values gives.
struct FileValues {
  std::optional<std::vector<std::byte>> raw = {};
  std::optional<program::NpyArray> array = {};
  std::optional<std::vector<std::string>> texts = {};

  std::uint64_t scalars() const {
    return texts ? texts->size() : array ? array->bytes.size() / program::size_of(array->scalar) : 0;
  }
};

FileValues values_of(const Setting& setting, const Source& source) {
  if (source.kind == SourceKind::values) return {.texts = source.values};
  if (source.kind != SourceKind::file) return {};
  if (is_npy(source.file)) return {.array = program::read_npy(source.file)};
  if (is_table(source.file)) return {.texts = program::read_table(source.file)};
  if (is_raw(source.file)) return {.raw = bytes_of(read_bytes(source.file, most_bytes))};
  refuse(setting, fmt::format("'{}' is neither zeros, iota, random:SEED, a list of numbers, nor a file whose name ends "
                              "in .bin, .raw, .npy, .csv or .txt",
                              shortened(source.file.string())));
}

void fill(const Setting& setting, const Source& source, const FileValues& values, const ValueType& type,
          std::span<std::byte> bytes) {
  try {
    if (source.kind == SourceKind::iota) program::fill_iota(bytes, type);
    if (source.kind == SourceKind::random) {
      const auto [least, most] = source.range.value_or(std::array{0.0, 1.0});
      program::fill_random(bytes, type, source.seed, least, most);
    }
    if (values.raw) std::ranges::copy(*values.raw, bytes.begin());
    if (values.array) program::fill_from(bytes, type, *values.array);
    if (values.texts) program::fill_values(bytes, type, *values.texts);
  } catch (const Error& error) {
    refuse(setting, source.file.empty() ? std::string(error.what())
                                        : fmt::format("'{}': {}", shortened(source.file.string()), error.what()));
  }
}

std::uint64_t size_of_buffer(const Setting& setting, const BufferWords& words, const FileValues& values,
                             const ValueType& type) {
  const std::uint64_t least = program::size_with(type, 1);
  if (words.bytes) return std::max(*words.bytes, least);
  if (words.elements) {
    if (program::unsized_array(type) == nullptr)
      refuse(setting,
             fmt::format("{} elements of '{}', which is no array without a length", *words.elements, setting.key));
    if (*words.elements > most_bytes) refuse(setting, fmt::format("{} elements are too many", *words.elements));
    return std::max(program::size_with(type, *words.elements), least);
  }
  if (values.raw) return std::max<std::uint64_t>(values.raw->size(), least);
  if (values.scalars() > 0)
    return std::max(program::size_with(type, program::elements_for(type, values.scalars())), least);
  if (program::unsized_array(type) != nullptr)
    refuse(setting, fmt::format("'{}' has an array without a length; say how many elements, as in {}={}:1024",
                                setting.key, setting.key, setting.value));
  return least;
}

pathtracer::DecodedImage decode(const Setting& setting, const std::filesystem::path& file) {
  check_input(file);
  try {
    return pathtracer::decode_image(file);
  } catch (const Error& error) {
    refuse(setting, fmt::format("cannot read '{}': {}", shortened(file.string()), error.what()));
  }
}

/// Four floats a texel: grey is red, green and blue.
std::vector<float> rgba_of(const pathtracer::DecodedImage& image) {
  std::vector<float> rgba(std::size_t{image.width} * image.height * 4, 1.0f);
  for (std::size_t texel = 0; texel < rgba.size() / 4; ++texel)
    for (std::uint32_t i = 0; i < 4; ++i) {
      const bool is_grey = image.channels <= 2;
      const std::uint32_t channel = is_grey ? (i < 3 ? 0 : 1) : i;
      if (channel < image.channels) rgba[4 * texel + i] = image.values[texel * image.channels + channel];
    }
  return rgba;
}

rhi::TextureFormat usual_format(const rhi::ShaderBinding& binding, const pathtracer::DecodedImage* picture) {
  if (binding.format) return *binding.format;
  if (binding.component == rhi::ComponentKind::uint) return rhi::TextureFormat::rgba32_uint;
  if (binding.component == rhi::ComponentKind::sint) return rhi::TextureFormat::rgba32_sint;
  if (binding.compares) return rhi::TextureFormat::d32_float;
  const bool is_float = picture != nullptr && picture->type != pathtracer::StoredType::unorm8;
  return is_float ? rhi::TextureFormat::rgba32_float : rhi::TextureFormat::rgba8_unorm;
}

/// The image with its first level alone, as files hold it.
std::span<const std::byte> first_level(const rhi::TextureDesc& desc, std::span<const std::byte> bytes) {
  rhi::TextureDesc flat = desc;
  flat.size[2] = 1;
  flat.dimension = rhi::TextureDimension::d2;
  if (rhi::side_count(desc.dimension) == 1) flat.size[1] = 1;
  return bytes.first(static_cast<std::size_t>(rhi::level_size_in_bytes(flat, 0)));
}

std::vector<pathtracer::ImageChannel> channels_of(const rhi::TextureDesc& desc, std::span<const std::byte> texels) {
  const rhi::TextureFormatInfo& info = rhi::info_of(desc.format);
  const std::vector<float> rgba = program::rgba_of(desc.format, texels);
  const bool is_integer = info.kind == rhi::ComponentKind::uint;
  std::vector<pathtracer::ImageChannel> channels;
  for (std::uint32_t i = 0; i < info.components; ++i) {
    pathtracer::ImageChannel channel{.name = std::string(1, "RGBA"[i]), .is_integer = is_integer, .words = {}};
    for (std::size_t texel = 0; texel < rgba.size() / 4; ++texel) {
      std::uint32_t word = 0;
      if (is_integer)
        std::memcpy(&word, texels.data() + texel * info.size + i * (info.size / info.components),
                    std::min<std::size_t>(info.size / info.components, 4));
      else
        std::memcpy(&word, &rgba[4 * texel + i], 4);
      channel.words.push_back(word);
    }
    channels.push_back(std::move(channel));
  }
  return channels;
}

std::vector<std::uint8_t> rgb_of(const rhi::TextureDesc& desc, std::span<const std::byte> texels) {
  const rhi::TextureFormatInfo& info = rhi::info_of(desc.format);
  const std::vector<float> rgba = program::rgba_of(desc.format, texels);
  const bool is_linear = info.kind == rhi::ComponentKind::floating || info.kind == rhi::ComponentKind::depth;
  std::vector<std::uint8_t> rgb;
  for (std::size_t texel = 0; texel < rgba.size() / 4; ++texel) {
    const float* const c = &rgba[4 * texel];
    glm::vec3 color = info.components == 1 ? glm::vec3(c[0]) : glm::vec3(c[0], c[1], c[2]);
    if (is_linear) color = pathtracer::tone_mapped(color, {});
    for (int i = 0; i < 3; ++i)
      rgb.push_back(static_cast<std::uint8_t>(std::lround(std::clamp(color[i], 0.0f, 1.0f) * 255.0f)));
  }
  return rgb;
}

}  // namespace

std::vector<std::byte> buffer_contents(const Setting& setting, const BufferWords& words, const ValueType& type) {
  const FileValues values = values_of(setting, words.source);
  const std::uint64_t size = size_of_buffer(setting, words, values, type);
  if (size > most_bytes) refuse(setting, fmt::format("'{}' would have {} bytes, more than 4 GiB", setting.key, size));
  if (values.raw && values.raw->size() > size)
    refuse(setting, fmt::format("'{}' has {} bytes, more than the {} of '{}'", shortened(words.source.file.string()),
                                values.raw->size(), size, setting.key));
  std::vector<std::byte> bytes(static_cast<std::size_t>(size));
  fill(setting, words.source, values, type, bytes);
  return bytes;
}

program::Image image_contents(const Setting& setting, const ImageWords& words, const rhi::ShaderBinding& binding) {
  std::optional<pathtracer::DecodedImage> picture;
  if (words.source.kind == SourceKind::file && is_picture(words.source.file))
    picture = decode(setting, words.source.file);
  program::Image image;
  image.desc = {.dimension = binding.dimension,
                .format = words.format.value_or(usual_format(binding, picture ? &*picture : nullptr)),
                .level_count = words.levels,
                .label = binding.name};
  if (words.size)
    image.desc.size = *words.size;
  else if (picture)
    image.desc.size = {picture->width, picture->height, 1};
  else
    refuse(setting, fmt::format("'{}' has no size, such as {}=512x512", setting.key, setting.key));
  const bool is_cube =
      binding.dimension == rhi::TextureDimension::cube || binding.dimension == rhi::TextureDimension::cube_array;
  if (is_cube && image.desc.size[2] == 1) image.desc.size[2] = 6;
  if (binding.dimension == rhi::TextureDimension::d1_array && image.desc.size[2] == 1)
    image.desc.size = {image.desc.size[0], 1, image.desc.size[1]};
  if (image.desc.level_count == 0 || image.desc.level_count > rhi::full_level_count(image.desc))
    refuse(setting, fmt::format("'{}' has up to {} levels", setting.key, rhi::full_level_count(image.desc)));

  const ValueType type = program::texture_type(image.desc);
  std::uint64_t size = rhi::size_of(image.desc.format);
  for (const std::uint32_t side : image.desc.size) {
    if (side == 0 || size > most_bytes / side) refuse(setting, fmt::format("'{}' is too large", setting.key));
    size *= side;
  }
  image.initial.resize(static_cast<std::size_t>(type.size));
  if (!picture) {
    const FileValues values = values_of(setting, words.source);
    if (values.raw && values.raw->size() > image.initial.size())
      refuse(setting, fmt::format("'{}' has {} bytes, more than the {} of the image",
                                  shortened(words.source.file.string()), values.raw->size(), image.initial.size()));
    fill(setting, words.source, values, type, image.initial);
    return image;
  }
  if (picture->width != image.desc.size[0] || picture->height != image.desc.size[1] || image.desc.size[2] != 1)
    refuse(setting, fmt::format("'{}' has {}x{} pixels, which are not those of the image",
                                shortened(words.source.file.string()), picture->width, picture->height));
  if (!program::has_plain_components(image.desc.format))
    refuse(setting, fmt::format("an image of the format {} cannot be read from a picture",
                                rhi::info_of(image.desc.format).name));
  std::vector<float> rgba = rgba_of(*picture);
  // Whole numbers of a picture of 8 bits are those that the file holds.
  const rhi::ComponentKind kind = rhi::info_of(image.desc.format).kind;
  const bool is_whole = kind == rhi::ComponentKind::uint || kind == rhi::ComponentKind::sint;
  if (is_whole && picture->type == pathtracer::StoredType::unorm8)
    for (float& value : rgba) value = std::round(value * 255.0f);
  std::ranges::copy(program::texels_of(image.desc.format, rgba), image.initial.begin());
  return image;
}

bool is_picture(const std::filesystem::path& file) {
  return extension_of(file) == ".png" || extension_of(file) == ".exr" || extension_of(file) == ".jpg" ||
         extension_of(file) == ".jpeg" || extension_of(file) == ".hdr";
}

std::vector<std::byte> encode_values(const std::filesystem::path& file, const ValueType& type,
                                     std::span<const std::byte> bytes) {
  if (is_npy(file)) return program::to_npy(program::npy_of(type, bytes));
  if (extension_of(file) == ".csv") return bytes_of(program::to_csv(type, bytes));
  if (extension_of(file) == ".txt")
    return bytes_of(program::to_columns(type, bytes, std::numeric_limits<std::size_t>::max()));
  return {bytes.begin(), bytes.end()};
}

std::vector<std::byte> encode_picture(const std::filesystem::path& file, const rhi::TextureDesc& desc,
                                      std::span<const std::byte> bytes) {
  if (!program::has_plain_components(desc.format))
    throw Error(fmt::format("cannot write '{}': an image of the format {} becomes no picture", shortened(file.string()),
                            rhi::info_of(desc.format).name));
  const std::span<const std::byte> texels = first_level(desc, bytes);
  const std::uint32_t height = rhi::side_count(desc.dimension) == 1 ? 1 : desc.size[1];
  if (extension_of(file) == ".png") return pathtracer::encode_png(desc.size[0], height, rgb_of(desc, texels), {});
  return pathtracer::encode_exr(desc.size[0], height, channels_of(desc, texels), {});
}

void check_extension(const Setting& setting, bool is_image) {
  const std::filesystem::path file = setting.value;
  if (is_raw(file) || is_npy(file) || is_table(file)) return;
  if (is_image && (extension_of(file) == ".png" || extension_of(file) == ".exr")) return;
  refuse(setting, fmt::format("'{}' does not end in .bin, .raw, .npy, .csv or .txt{}", shortened(setting.value),
                              is_image ? ", .png or .exr" : ""));
}

}  // namespace tandem::tools::program_run
