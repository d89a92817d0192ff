#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <tuple>

#include "base/json_value.hpp"
#include "pathtracer/image/texture_image.hpp"
#include "pathtracer/load/access/load_options.hpp"
#include "pathtracer/load/description/ranges.hpp"
#include "pathtracer/scene/scene.hpp"

namespace tandem::pathtracer::description {

/// What a texture is read for: it decides how its image is encoded and which channel a number comes from, where the
/// description does not say.
enum class TextureUse {
  color,    ///< sRGB-encoded
  number,   ///< linear, the red channel
  opacity,  ///< linear, the alpha channel
  vector    ///< linear: normals
};

/// The named textures of a description. They are added to a scene when something uses them.
class Textures {
 public:
  /// Reads the definitions, but no image yet. Throws Error.
  /// @param folder that file names are relative to
  /// @param options say which files may be read
  /// @param scene where textures and images are added; must outlive this object
  Textures(const std::optional<Value>& definitions, std::filesystem::path folder, const LoadOptions& options,
           Scene& scene);

  /// The index in the scene of the texture that the value names. Throws Error when there is none of this name, or its
  /// image cannot be read.
  std::uint32_t use(const Value& name, TextureUse use);
  /// Of an image file that is not among the named ones, repeated in u only.
  std::uint32_t use_environment(const Value& file);

 private:
  struct Definition {
    GpuTexture gpu;
    std::optional<Value> file;  ///< of an image
    std::optional<TextureEncoding> encoding;
    std::optional<std::uint32_t> channel;
  };
  static Definition read_definition(const Value& value);
  std::uint32_t image(const Value& file, TextureEncoding encoding);

  std::filesystem::path folder_;
  LoadOptions options_;
  Scene* scene_;
  std::map<std::string, Definition> definitions_;
  std::map<std::tuple<std::string, TextureEncoding>, std::uint32_t> images_;                   ///< by path
  std::map<std::tuple<std::string, TextureEncoding, std::uint32_t>, std::uint32_t> textures_;  ///< by name and channel
};

}  // namespace tandem::pathtracer::description
