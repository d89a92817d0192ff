#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "pathtracer/load/access/load_options.hpp"
#include "pathtracer/load/obj/mtl_loader.hpp"
#include "pathtracer/load/obj/mtl_texture.hpp"
#include "pathtracer/load/obj/wavefront_text.hpp"
#include "pathtracer/scene/scene.hpp"

namespace tandem::pathtracer {

/// The materials of an OBJ file. Which one a face has is known at the end of the file only, since a library may be
/// named behind the statements that use it; and what no face uses may be wrong.
class ObjMaterials {
 public:
  /// In place of what use() returns: the material of faces before the first usemtl.
  static constexpr std::uint32_t unnamed = 0;

  /// @param text for the places of messages  @param options with a folder (options_within)  @param scene gets warnings
  /// and, by resolve(), the materials; both must outlive this object
  ObjMaterials(const WavefrontText& text, LoadOptions options, Scene& scene);

  /// The statement mtllib: one file name, or several without blanks. Throws Error.
  void load_libraries(std::string_view names);
  /// The statement usemtl. Returns a number for the name.
  std::uint32_t use(std::string_view name);
  /// Adds the materials to the scene, and the textures of those that are used. Returns the scene's material for each
  /// number of use(). @param used whether a face has it, for each number, but for the last ones maybe. Throws Error for
  /// what is used and cannot be.
  std::vector<std::uint32_t> resolve(std::vector<bool> used);

 private:
  /// A material of a library.
  struct Entry {
    NamedMaterial material;
    std::filesystem::path folder;  ///< of its library
    std::string place;             ///< of the mtllib statement, for messages
  };

  void load_library(const std::string& name);
  void load_textures(Entry& entry);
  std::uint32_t add(const std::string& name, const GpuMaterial& material);

  const WavefrontText* text_;
  LoadOptions options_;
  Scene* scene_;
  std::set<std::string> libraries_;
  std::vector<Entry> entries_;
  std::map<std::string, std::size_t, std::less<>> entry_names_;  ///< index into entries_
  std::vector<std::string> uses_ = {""};                         ///< by number
  std::map<std::string, std::uint32_t, std::less<>> use_numbers_;
  TextureFiles textures_;
  std::set<std::filesystem::path> missing_textures_;
};

}  // namespace tandem::pathtracer
