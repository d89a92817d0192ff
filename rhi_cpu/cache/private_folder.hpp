#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <variant>

#include "base/file_descriptor.hpp"

namespace tandem::cpu {

/// What became of opening a file of a private folder.
struct PrivateFile {
  FileDescriptor descriptor;  ///< for reading, at the beginning; none when there is no such file or it is refused
  std::string problem;        ///< why it is refused: "belongs to another user"; "" otherwise
};

/// A folder in which nobody but this user (and root) can create, rename, or change anything: it and all folders above
/// it belong to this user or to root, and only their owner may write them. Above it, a folder that others may write is
/// accepted if it is sticky, as /tmp is: nobody can rename what is another's there. The model is OpenSSH's StrictModes.
class PrivateFolder {
 public:
  /// Follows the path from the root, symbolic links included, and creates what is missing with mode 0700.
  /// @param folder absolute
  /// @return the folder, or the end of a sentence that says why it cannot be used: "cannot be created: ..."
  static std::variant<PrivateFolder, std::string> open(const std::filesystem::path& folder);

  /// Without symbolic links.
  const std::filesystem::path& path() const noexcept { return path_; }

  /// Opens a regular file that belongs to this user or to root and that only its owner may write. It does not follow
  /// symbolic links and does not wait for the other end of a pipe.
  /// @param name without folders
  PrivateFile open_file(std::string_view name) const;

 private:
  PrivateFolder(FileDescriptor descriptor, std::filesystem::path path);

  FileDescriptor descriptor_;
  std::filesystem::path path_;
};

}  // namespace tandem::cpu
