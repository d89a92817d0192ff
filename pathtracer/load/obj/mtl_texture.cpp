#include "pathtracer/load/obj/mtl_texture.hpp"

#include <bit>
#include <system_error>

#include "pathtracer/image/texture_image.hpp"
#include "pathtracer/load/access/file_access.hpp"

namespace tandem::pathtracer {
namespace {

TextureImage load(const std::filesystem::path& file, MapKind kind) {
  if (kind == MapKind::opacity) return load_alpha_texture(file);
  return load_texture_image(file, kind == MapKind::color ? TextureEncoding::color : TextureEncoding::data);
}

}  // namespace

std::optional<std::filesystem::path> find_texture(const std::filesystem::path& folder,
                                                  const std::filesystem::path& name, const LoadOptions& options) {
  const std::filesystem::path last = name.filename();
  const std::filesystem::path candidates[] = {folder / name, folder / last, folder / "textures" / last,
                                              folder / ".." / "textures" / last};
  std::error_code status_error;
  for (const std::filesystem::path& candidate : candidates)
    if (std::filesystem::exists(candidate, status_error) && !std::filesystem::is_directory(candidate, status_error) &&
        may_read(candidate, options))
      return candidate.lexically_normal();
  return {};
}

std::uint32_t texture_of(Scene& scene, TextureFiles& files, const std::filesystem::path& file, const MaterialMap& map) {
  const auto [entry, is_new] =
      files.images.try_emplace({file, map.kind}, static_cast<std::uint32_t>(scene.images.size()));
  if (is_new) scene.images.push_back(load(file, map.kind));
  const std::uint32_t image = entry->second;
  const TextureFiles::Use use(image, std::bit_cast<std::array<std::byte, sizeof(GpuTexture)>>(map.texture));
  const auto [texture, is_new_use] = files.textures.try_emplace(use, static_cast<std::uint32_t>(scene.textures.size()));
  if (is_new_use) scene.textures.push_back({.gpu = map.texture, .image = image});
  return texture->second;
}

}  // namespace tandem::pathtracer
