#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

namespace tandem {

/// A file that appears under its name whole or not at all: it is written under a temporary name in the same folder and
/// renamed by commit(). Without commit() the destructor removes it.
class AtomicFile {
 public:
  /// Creates the empty temporary file. Throws Error when that is not possible or `path` is a folder.
  explicit AtomicFile(std::filesystem::path path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Where to write. It has the extension of the final name.
  const std::filesystem::path& temporary_path() const noexcept { return temporary_path_; }

  /// Makes `bytes` all that the temporary file holds. Throws Error, with the system's reason, unless it took every
  /// byte.
  void write(std::span<const std::byte> bytes);

  /// Gives the file its name, replacing an older one. Throws Error.
  void commit();

 private:
  std::filesystem::path path_;
  std::filesystem::path temporary_path_;
  bool committed_ = false;
};

}  // namespace tandem
