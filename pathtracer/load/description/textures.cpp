#include "pathtracer/load/description/textures.hpp"

#include <cmath>

#include <glm/trigonometric.hpp>

#include "pathtracer/load/access/file_access.hpp"

namespace tandem::pathtracer::description {
namespace {

constexpr Named<TextureKind> kinds[] = {{TextureKind::image, "image"},
                                        {TextureKind::checker, "checker"},
                                        {TextureKind::noise, "noise"},
                                        {TextureKind::uniform, "uniform"}};
constexpr Named<TextureEncoding> encodings[] = {{TextureEncoding::color, "color"}, {TextureEncoding::data, "data"}};
constexpr Named<TextureAddress> addresses[] = {
    {TextureAddress::repeat, "repeat"}, {TextureAddress::clamp, "clamp"}, {TextureAddress::mirror, "mirror"}};
constexpr Named<TextureFilter> filters[] = {{TextureFilter::nearest, "nearest"}, {TextureFilter::linear, "linear"}};
constexpr Named<std::uint32_t> channels[] = {
    {0, "red"}, {1, "green"}, {2, "blue"}, {3, "alpha"}, {luminance_channel, "luminance"}};
constexpr Range frequency{0, 1e6, true};
constexpr std::uint32_t alpha_channel = 3;

std::uint32_t address_word(TextureAddress u, TextureAddress v) {
  return static_cast<std::uint32_t>(u) | static_cast<std::uint32_t>(v) << 8;
}

std::uint32_t read_wrap(const Value& value) {
  if (!value.is_array())
    return address_word(value.choice<TextureAddress>(addresses), value.choice<TextureAddress>(addresses));
  const std::vector<Value> both = value.elements(2);
  return address_word(both[0].choice<TextureAddress>(addresses), both[1].choice<TextureAddress>(addresses));
}

/// Scales, then rotates, then moves the texture's coordinates.
void read_transform(const Value& value, GpuTexture& texture) {
  const Object transform(value, {"scale", "rotate", "offset"});
  float scale[2] = {1, 1};
  float offset[2] = {0, 0};
  const auto pair = [](const Value& values, float(&target)[2]) {
    const std::vector<Value> both = values.elements(2);
    for (std::size_t i = 0; i < 2; ++i) target[i] = both[i].number(any_length);
  };
  if (const std::optional<Value> given = transform.get("scale")) {
    if (given->is_array())
      pair(*given, scale);
    else
      scale[0] = scale[1] = given->number(any_length);
  }
  if (const std::optional<Value> given = transform.get("offset")) pair(*given, offset);
  double degrees = 0;
  if (const std::optional<Value> given = transform.get("rotate")) degrees = double{given->number(any_length)};
  const auto cosine = static_cast<float>(std::cos(glm::radians(degrees)));
  const auto sine = static_cast<float>(std::sin(glm::radians(degrees)));
  texture.u_row = {cosine * scale[0], -sine * scale[1], offset[0]};
  texture.v_row = {sine * scale[0], cosine * scale[1], offset[1]};
}

std::vector<std::string> keys_of(TextureKind kind) {
  switch (kind) {
    case TextureKind::image:
      return {"type", "file", "encoding", "wrap", "filter", "transform", "channel", "factor"};
    case TextureKind::checker:
      return {"type", "scale", "color_a", "color_b", "transform", "channel"};
    case TextureKind::noise:
      return {"type", "scale", "color_a", "color_b", "channel"};
    case TextureKind::uniform:
      return {"type", "color", "channel"};
  }
  return {};
}

}  // namespace

Textures::Textures(const std::optional<Value>& definitions, std::filesystem::path folder, const LoadOptions& options,
                   Scene& scene)
    : folder_(std::move(folder)), options_(options), scene_(&scene) {
  if (!definitions) return;
  for (const auto& [name, value] : definitions->members()) definitions_.emplace(name, read_definition(value));
}

Textures::Definition Textures::read_definition(const Value& value) {
  Definition definition;
  GpuTexture& gpu = definition.gpu;
  gpu.kind = type_of<TextureKind>(value, kinds);
  const Object object(value, keys_of(gpu.kind));
  if (const std::optional<Value> channel = object.get("channel"))
    definition.channel = channel->choice<std::uint32_t>(channels);
  if (gpu.kind == TextureKind::uniform) {
    gpu.color_a = object.require("color").color(radiance_range);
    return definition;
  }
  if (gpu.kind == TextureKind::image) {
    definition.file = object.require("file");
    definition.file->text();
    if (const std::optional<Value> encoding = object.get("encoding"))
      definition.encoding = encoding->choice<TextureEncoding>(encodings);
    if (const std::optional<Value> wrap = object.get("wrap")) gpu.address = read_wrap(*wrap);
    if (const std::optional<Value> filter = object.get("filter")) gpu.filter = filter->choice<TextureFilter>(filters);
    object.read("factor", gpu.color_a, &Value::color, radiance_range);
  } else {
    gpu.scale = object.require("scale").number(frequency);
    gpu.color_a = object.require("color_a").color(radiance_range);
    gpu.color_b = object.require("color_b").color(radiance_range);
  }
  if (gpu.kind != TextureKind::noise)
    if (const std::optional<Value> transform = object.get("transform")) read_transform(*transform, gpu);
  return definition;
}

std::uint32_t Textures::image(const Value& file, TextureEncoding encoding) {
  const std::filesystem::path path = folder_ / file.text();
  if (!may_read(path, options_)) file.fail(fmt::format("cannot be read: {}", outside_sentence(path)));
  const auto [entry, is_new] =
      images_.try_emplace({path.string(), encoding}, static_cast<std::uint32_t>(scene_->images.size()));
  if (is_new) scene_->images.push_back(load_texture_image(path, encoding));
  return entry->second;
}

std::uint32_t Textures::use(const Value& name, TextureUse use) {
  const auto found = definitions_.find(name.text());
  if (found == definitions_.end())
    name.fail(fmt::format("names '{}', which is not among the textures", shortened(name.text())));
  const Definition& definition = found->second;
  const TextureEncoding encoding =
      definition.encoding.value_or(use == TextureUse::color ? TextureEncoding::color : TextureEncoding::data);
  const bool reads_alpha = use == TextureUse::opacity && definition.gpu.kind == TextureKind::image;
  const std::uint32_t channel = definition.channel.value_or(reads_alpha ? alpha_channel : 0);
  const auto [entry, is_new] =
      textures_.try_emplace({found->first, encoding, channel}, static_cast<std::uint32_t>(scene_->textures.size()));
  if (!is_new) return entry->second;
  Texture texture{.gpu = definition.gpu, .image = definition.file ? image(*definition.file, encoding) : 0};
  texture.gpu.channel = channel;
  scene_->textures.push_back(texture);
  return entry->second;
}

std::uint32_t Textures::use_environment(const Value& file) {
  Texture texture{.gpu = {}, .image = image(file, TextureEncoding::color)};
  texture.gpu.address = address_word(TextureAddress::repeat, TextureAddress::clamp);
  scene_->textures.push_back(texture);
  return static_cast<std::uint32_t>(scene_->textures.size() - 1);
}

}  // namespace tandem::pathtracer::description
