#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

#include "base/unfinished_path.hpp"

namespace tandem {

/// The file that is written when `path` is: where its symbolic links lead, whether or not there is a file; a path that
/// is no link itself. Throws Error for links in a circle.
std::filesystem::path link_target(std::filesystem::path path);

/// A file that appears under its name whole or not at all: it is written under a temporary name in the same folder and
/// renamed by commit(). Without commit() the destructor removes it. A symbolic link stays; the file that it names is
/// written.
class AtomicFile {
 public:
  /// Creates the empty temporary file. Throws Error when that is not possible or `path` is a folder.
  explicit AtomicFile(std::filesystem::path path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Where to write. It has the extension of the file.
  const std::filesystem::path& temporary_path() const noexcept { return temporary_path_; }

  /// Makes `bytes` all that the temporary file holds. Throws Error, with the system's reason, unless it took every
  /// byte.
  void write(std::span<const std::byte> bytes);

  /// Gives the file its name, replacing an older one. Throws Error.
  void commit();

 private:
  std::filesystem::path path_;    ///< as it is called
  std::filesystem::path target_;  ///< where its links lead
  std::filesystem::path temporary_path_;
  UnfinishedPath unfinished_;
  bool committed_ = false;
};

}  // namespace tandem
