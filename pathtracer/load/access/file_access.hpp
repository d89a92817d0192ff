#pragma once

#include <filesystem>
#include <string>

#include "pathtracer/load/access/load_options.hpp"

namespace tandem::pathtracer {

/// The options for the files that `file` names: their `folder` is that of `file`, unless it is set already.
LoadOptions options_within(const std::filesystem::path& file, LoadOptions options);

/// Whether a file that a scene names lies in `options.folder` or in the folder `textures` beside it, where exporters
/// put images, after symbolic links have been followed; or whether `options` allow any file. A scene that comes from
/// somebody else thus tells nothing about other files of this machine. The file need not exist.
bool may_read(const std::filesystem::path& file, const LoadOptions& options);

/// "the file '../a.png' is outside of the scene's folder; --allow-outside-files allows it"
std::string outside_sentence(const std::filesystem::path& file);

}  // namespace tandem::pathtracer
