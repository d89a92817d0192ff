#pragma once

#include <filesystem>

namespace tandem {

/// A file or an empty folder that is to go if the process ends in the middle, as it does when a signal finds it in a
/// place that nothing can interrupt. While the object lives, remove_unfinished_paths removes the path.
class UnfinishedPath {
 public:
  UnfinishedPath() = default;
  explicit UnfinishedPath(const std::filesystem::path& path);
  ~UnfinishedPath();
  UnfinishedPath(UnfinishedPath&& other) noexcept;
  UnfinishedPath& operator=(UnfinishedPath&& other) noexcept;

 private:
  int slot_ = -1;
};

/// For a signal handler that ends the process: it calls only what POSIX allows there (signal-safety(7)).
void remove_unfinished_paths() noexcept;

}  // namespace tandem
