#include "pathtracer/load/obj/mtl_texture.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <system_error>

#include "pathtracer/image/texture_image.hpp"

namespace tandem::pathtracer {
namespace {

TextureImage load(const std::filesystem::path& file, MapKind kind) {
  if (kind == MapKind::opacity) return load_alpha_texture(file);
  return load_texture_image(file, kind == MapKind::color ? TextureEncoding::color : TextureEncoding::data);
}

/// Whether two textures of the same image read it in the same way.
bool same_use(const GpuTexture& a, const GpuTexture& b) {
  using Bytes = std::array<std::byte, sizeof(GpuTexture)>;
  return std::bit_cast<Bytes>(a) == std::bit_cast<Bytes>(b);
}

}  // namespace

std::optional<std::filesystem::path> find_texture(const std::filesystem::path& folder,
                                                  const std::filesystem::path& name) {
  const std::filesystem::path last = name.filename();
  const std::filesystem::path candidates[] = {folder / name, folder / last, folder / "textures" / last,
                                              folder / ".." / "textures" / last};
  std::error_code status_error;
  for (const std::filesystem::path& candidate : candidates)
    if (std::filesystem::is_regular_file(candidate, status_error)) return candidate.lexically_normal();
  return {};
}

std::uint32_t texture_of(Scene& scene, TextureFiles& files, const std::filesystem::path& file, const MaterialMap& map) {
  const auto [entry, is_new] = files.try_emplace({file, map.kind}, static_cast<std::uint32_t>(scene.images.size()));
  if (is_new) scene.images.push_back(load(file, map.kind));
  const std::uint32_t image = entry->second;
  const auto same = [&](const Texture& texture) {
    return texture.image == image && same_use(texture.gpu, map.texture);
  };
  const auto known = std::ranges::find_if(scene.textures, same);
  const auto index = static_cast<std::uint32_t>(known - scene.textures.begin());
  if (known == scene.textures.end()) scene.textures.push_back({.gpu = map.texture, .image = image});
  return index;
}

}  // namespace tandem::pathtracer
