#include "pathtracer/scene/hash.hpp"

#include <cstdint>
#include <memory>
#include <new>
#include <optional>
#include <span>
#include <type_traits>
#include <vector>

#include <fmt/format.h>

// Inlined, so that programs which use Tandem need no xxhash library.
#define XXH_INLINE_ALL
#include <xxhash.h>

namespace tandem::pathtracer {
namespace {

/// Hashes values one after the other, each list after its length, so that none runs into the next.
class Hasher {
 public:
  Hasher() : state_(XXH3_createState()) {
    if (!state_) throw std::bad_alloc();
    XXH3_128bits_reset(state_.get());
  }

  template <typename T>
  void add(const std::vector<T>& values) {
    add_value(std::uint64_t{values.size()});
    add_bytes(std::as_bytes(std::span(values)));
  }
  template <typename T>
  void add(const std::optional<T>& value) {
    add_value(std::uint32_t{value.has_value()});
    if (value) add_value(*value);
  }
  /// Of a type without padding, all of which are made of words here.
  template <typename T>
  void add_value(const T& value) {
    add_bytes(std::as_bytes(std::span(&value, 1)));
  }
  std::string hex() const {
    const XXH128_hash_t hash = XXH3_128bits_digest(state_.get());
    return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
  }

 private:
  struct Free {
    void operator()(XXH3_state_t* state) const { XXH3_freeState(state); }
  };

  void add_bytes(std::span<const std::byte> bytes) {
    if (!bytes.empty()) XXH3_128bits_update(state_.get(), bytes.data(), bytes.size());
  }

  std::unique_ptr<XXH3_state_t, Free> state_;
};

}  // namespace

std::string scene_hash(const Scene& scene) {
  Hasher hasher;
  hasher.add(scene.positions);
  hasher.add(scene.normals);
  hasher.add(scene.texture_coordinates);
  if (!scene.attributes.empty()) hasher.add(scene.attributes);
  hasher.add(scene.triangles);
  hasher.add(scene.spheres);
  hasher.add(scene.materials);
  hasher.add_value(std::uint64_t{scene.images.size()});
  for (const TextureImage& image : scene.images) {
    hasher.add_value(image.format);
    hasher.add_value(image.width);
    hasher.add_value(image.height);
    hasher.add(image.texels);
  }
  hasher.add_value(std::uint64_t{scene.textures.size()});
  for (const Texture& texture : scene.textures) {
    hasher.add_value(texture.gpu);
    hasher.add_value(texture.image);
  }
  hasher.add(scene.lights);
  hasher.add(scene.environment);
  hasher.add(scene.media);
  hasher.add_value(scene.medium);
  hasher.add(scene.camera);
  return hasher.hex();
}

}  // namespace tandem::pathtracer
