#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace tandem::test {

/// A new folder among the temporary files, removed with all that is in it. Its name is its own: tests and programs that
/// run at the same time never share one.
class ScratchFolder {
 public:
  /// Throws std::system_error if the folder cannot be made.
  ScratchFolder();
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  const std::filesystem::path& path() const noexcept { return path_; }
  /// Writes the text as a file of the folder; returns its path.
  std::filesystem::path write(std::string_view name, std::string_view text) const;
  /// Names of the files and folders in it, sorted; hidden ones too.
  std::vector<std::string> names() const;

 private:
  std::filesystem::path path_;
};

/// Throw std::runtime_error if the file cannot be read or written.
std::string read_text(const std::filesystem::path& path);
void write_text(const std::filesystem::path& path, std::string_view text);

}  // namespace tandem::test
