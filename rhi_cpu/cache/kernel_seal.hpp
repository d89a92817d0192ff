#pragma once

#include <filesystem>

#include "rhi_cpu/cache/content_hash.hpp"

/// The last bytes of every file in the kernel cache: its key and a checksum of what comes before them. A loader of
/// shared libraries does not look at bytes behind the last section.
namespace tandem::cpu {

/// Appends the seal. False when the file cannot be read or written.
bool seal_kernel_file(const std::filesystem::path& path, const ContentHash& key);

/// Whether the file is whole, unchanged since it was sealed, and sealed for this key.
bool kernel_file_is_sound(const std::filesystem::path& path, const ContentHash& key);

}  // namespace tandem::cpu
