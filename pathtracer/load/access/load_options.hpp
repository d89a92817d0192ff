#pragma once

#include <filesystem>

namespace tandem::pathtracer {

/// How a scene's file and those that it names are read.
struct LoadOptions {
  /// An MTL file that is not there is a warning, and its materials are grey; likewise a texture, of any format, which
  /// then has no effect.
  bool allow_missing_mtl = false;
  /// Files may name files anywhere; otherwise what may_read (file_access.hpp) says.
  bool allow_outside_files = false;
  /// The folder of the scene that is being opened, where one file names another; empty: that of the file itself.
  std::filesystem::path folder{};
};

}  // namespace tandem::pathtracer
