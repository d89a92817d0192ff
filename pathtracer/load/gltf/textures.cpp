#include "pathtracer/load/gltf/textures.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "pathtracer/load/gltf/uri.hpp"

namespace tandem::pathtracer {
namespace {

/// Whether a file is there to be read; otherwise a warning, where the options allow that.
bool is_there(GltfDocument& document, const tinygltf::Image& image, std::string_view name) {
  if (image.bufferView >= 0 || is_data_uri(image.uri)) return true;
  std::filesystem::path path;
  try {
    path = gltf_resource_path(document, image.uri, name);
  } catch (const Error& error) {
    if (!document.options.allow_missing_mtl) throw;
    if (std::ranges::find(document.warnings, error.what()) == document.warnings.end())
      document.warnings.push_back(error.what());
    return false;
  }
  std::error_code status_error;
  if (std::filesystem::exists(path, status_error)) return true;
  constexpr std::string_view sentence = "its file does not exist";
  if (!document.options.allow_missing_mtl) throw gltf_error(document, name, sentence);
  gltf_warn(document, fmt::format("{}: {}", name, sentence));
  return false;
}

/// Nothing for a file that need not be there and is not.
std::optional<std::uint32_t> load_image(GltfDocument& document, Scene& scene, GltfTextures& textures, int index,
                                        TextureEncoding encoding, std::string_view owner) {
  const auto entry = textures.images.find({index, encoding});
  if (entry != textures.images.end()) return entry->second;
  const tinygltf::Image& image = gltf_at(document, document.model.images, index, "image", owner);
  const std::string name = gltf_name("image", static_cast<std::size_t>(index),
                                     image.uri.empty() || is_data_uri(image.uri) ? image.name : image.uri);
  if (!is_there(document, image, name)) return std::nullopt;
  std::vector<unsigned char> file;
  if (image.bufferView < 0) file = gltf_resource(document, image.uri, name);
  const std::span<const unsigned char> bytes =
      image.bufferView >= 0 ? gltf_view(document, image.bufferView, name) : std::span<const unsigned char>(file);
  if (bytes.empty()) throw gltf_error(document, name, "is empty");
  scene.images.push_back(
      decode_texture_image(std::as_bytes(bytes), fmt::format("{}: {}", document.path, name), encoding));
  const auto position = static_cast<std::uint32_t>(scene.images.size() - 1);
  textures.images.emplace(std::pair(index, encoding), position);
  return position;
}

TextureAddress address(const GltfDocument& document, int wrap, std::string_view owner) {
  switch (wrap) {
    case TINYGLTF_TEXTURE_WRAP_REPEAT:
      return TextureAddress::repeat;
    case TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE:
      return TextureAddress::clamp;
    case TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT:
      return TextureAddress::mirror;
    default:
      throw gltf_error(document, owner, fmt::format("{} is not a texture wrap mode", wrap));
  }
}

void set_sampler(const GltfDocument& document, GpuTexture& texture, int index, std::string_view owner) {
  if (index < 0) return;
  const tinygltf::Sampler& sampler = gltf_at(document, document.model.samplers, index, "sampler", owner);
  const std::string name = gltf_name("sampler", static_cast<std::size_t>(index), sampler.name);
  texture.address = static_cast<std::uint32_t>(address(document, sampler.wrapS, name)) |
                    static_cast<std::uint32_t>(address(document, sampler.wrapT, name)) << 8;
  if (sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST) texture.filter = TextureFilter::nearest;
}

std::array<double, 2> pair(GltfDocument& document, const tinygltf::Value& transform, const std::string& member,
                           double absent, std::string_view owner) {
  std::array<double, 2> result{absent, absent};
  const tinygltf::Value* value = gltf_member(transform, member);
  if (value == nullptr) return result;
  if (value->ArrayLen() != 2 || !value->Get(0).IsNumber() || !value->Get(1).IsNumber())
    throw gltf_error(document, owner, fmt::format("{} of KHR_texture_transform is not a pair of numbers", member));
  for (int i = 0; i < 2; ++i)
    result[static_cast<std::size_t>(i)] =
        double{gltf_number(document, value->Get(i).GetNumberAsDouble(), -1e9, 1e9, owner, member)};
  return result;
}

/// The extension moves coordinates whose v points downwards: scaled, rotated counter-clockwise as the image is seen,
/// and shifted. Its examples and all its implementations turn by the inverse of the matrix that its text gives.
void set_transform(GltfDocument& document, GpuTexture& texture, const tinygltf::Value& transform,
                   std::string_view owner) {
  const std::array<double, 2> offset = pair(document, transform, "offset", 0, owner);
  const std::array<double, 2> scale = pair(document, transform, "scale", 1, owner);
  const tinygltf::Value* rotation = gltf_member(transform, "rotation");
  const double angle = rotation == nullptr
                           ? 0
                           : double{gltf_number(document, rotation->GetNumberAsDouble(), -1e9, 1e9, owner, "rotation")};
  const double sine = std::sin(angle), cosine = std::cos(angle);
  // u' = a u + b v + offset[0], v' = c u + d v + offset[1]; then both v are turned upwards.
  const double a = cosine * scale[0], b = sine * scale[1], c = -sine * scale[0], d = cosine * scale[1];
  texture.u_row = glm::vec3(a, -b, b + offset[0]);
  texture.v_row = glm::vec3(-c, d, 1 - d - offset[1]);
}

}  // namespace

std::uint32_t add_gltf_texture(GltfDocument& document, Scene& scene, GltfTextures& textures, int index,
                               const tinygltf::ExtensionMap& extensions, TextureEncoding encoding,
                               std::uint32_t channel, std::uint32_t coordinates, std::string_view owner) {
  const tinygltf::Texture& source = gltf_at(document, document.model.textures, index, "texture", owner);
  const std::string name = gltf_name("texture", static_cast<std::size_t>(index), source.name);
  if (source.source < 0) {
    gltf_warn(document, fmt::format("{} has no image in a supported format and has no effect", name));
    return no_texture;
  }
  Texture texture;
  texture.gpu.channel = channel;
  texture.gpu.coordinates = coordinates;
  const std::optional<std::uint32_t> image = load_image(document, scene, textures, source.source, encoding, name);
  if (!image) return no_texture;
  texture.image = *image;
  set_sampler(document, texture.gpu, source.sampler, name);
  if (const tinygltf::Value* transform = gltf_extension(extensions, "KHR_texture_transform"))
    set_transform(document, texture.gpu, *transform, owner);

  const GpuTexture& gpu = texture.gpu;
  const GltfTextures::View view{
      texture.image, channel,    coordinates,
      gpu.address,   gpu.filter, {gpu.u_row.x, gpu.u_row.y, gpu.u_row.z, gpu.v_row.x, gpu.v_row.y, gpu.v_row.z}};
  const auto [entry, is_new] = textures.views.try_emplace(view, static_cast<std::uint32_t>(scene.textures.size()));
  if (is_new) scene.textures.push_back(texture);
  return entry->second;
}

}  // namespace tandem::pathtracer
