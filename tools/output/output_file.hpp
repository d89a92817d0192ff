#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "base/unfinished_path.hpp"

/// Files that hold what took long to compute.
namespace tandem::tools {

/// Throws Error unless a file could be written there now.
void check_output_path(const std::filesystem::path& path);

/// A folder for results, made with its parents unless it exists. Those that were made are removed again when nothing
/// has been written into them by the time this object goes.
class OutputFolder {
 public:
  /// Throws Error when it cannot be made or is no folder.
  explicit OutputFolder(std::filesystem::path path);
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  const std::filesystem::path& path() const noexcept { return path_; }

 private:
  std::filesystem::path path_;
  std::vector<std::filesystem::path> made_;  ///< innermost first
  std::vector<UnfinishedPath> unfinished_;   ///< the same
};

/// Writes the text under a temporary name, then renames. Throws Error.
void write_text(const std::filesystem::path& path, const std::string& text);

struct OutputFile {
  std::filesystem::path path;
  std::function<void(const std::filesystem::path&)> write;  ///< writes the file whole or throws
};

/// Throws Error unless all of them could be written now, each beside the others.
void check_output_files(std::span<const OutputFile> files);

/// Writes the files. What cannot be written although its path was good before the computation (a disk that filled up
/// since) is saved under its name in a new folder for temporary files instead; then throws Error that says
/// why and where it is now.
void write_or_rescue(std::span<const OutputFile> files);

/// Says on standard output which files were written, a line for each folder, in the two columns of the tables.
void print_written(std::span<const OutputFile> files);

}  // namespace tandem::tools
