#pragma once

#include <filesystem>
#include <string>
#include <vector>

/// The real program as a subprocess.
namespace tandem::test {

struct Outcome {
  int exit_code = 0;  ///< -N: ended by signal N
  std::string output;
  std::string errors;
};

struct ProcessOptions {
  std::filesystem::path folder;     ///< current folder of the program; empty: that of the test
  unsigned interrupt_after_ms = 0;  ///< not 0: SIGINT after so long
  std::size_t file_size_limit = 0;  ///< not 0: bytes beyond which every write to a file fails
};

/// Runs `tandem ARGUMENTS...`, without a terminal.
Outcome run_tandem(const std::vector<std::string>& arguments, const ProcessOptions& options = {});

/// An empty folder that is removed with all that is in it.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const noexcept { return path_; }
  /// Names of what is in it, sorted; hidden files too.
  std::vector<std::string> names() const;

 private:
  std::filesystem::path path_;
};

std::string read_text(const std::filesystem::path& path);
void write_text(const std::filesystem::path& path, const std::string& text);

}  // namespace tandem::test
