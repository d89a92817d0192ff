#pragma once

#include <filesystem>
#include <string_view>

namespace tandem::test {

/// An empty folder of its own, removed with all it holds.
class ScratchFolder {
 public:
  ScratchFolder();
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  /// Writes the text as a file of the folder; returns its path.
  std::filesystem::path write(std::string_view name, std::string_view text) const;
  /// Number of files and folders in it.
  std::size_t size() const;

 private:
  std::filesystem::path path_;
};

}  // namespace tandem::test
