#pragma once

#include <filesystem>
#include <string>

namespace tandem::tools {

/// A file of the folder scenes/: of the working directory if it has one, else of what came with the program, installed,
/// bundled or built. "scenes/NAME" where there is none.
std::filesystem::path shipped_scene(const std::string& name);

}  // namespace tandem::tools
