#pragma once

#include <filesystem>
#include <string>

namespace tandem {

/// The whole of a text file, without the byte order mark with which some editors begin UTF-8 files. Throws Error,
/// naming the file, when it cannot be read, is empty, or holds a byte 0.
std::string read_text(const std::filesystem::path& path);

}  // namespace tandem
