#pragma once

#include "rhi_cpu/cache/content_hash.hpp"

/// The last bytes of every file in the kernel cache: its key and a checksum of what comes before them. A loader of
/// shared libraries does not look at bytes behind the last section.
namespace tandem::cpu {

/// Appends the seal and takes the right to write from everybody but the owner. False when the file cannot be read or
/// written.
/// @param file open for reading and writing
bool seal_kernel_file(int file, const ContentHash& key);

/// Whether the file is whole, unchanged since it was sealed, and sealed for this key.
/// @param file open for reading
bool kernel_file_is_sound(int file, const ContentHash& key);

}  // namespace tandem::cpu
