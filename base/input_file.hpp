#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

namespace tandem {

/// A file that the user names, open for reading. Every input goes through here: what has no end (a device) or may never
/// begin (a named pipe without a writer) is refused, not read.
class InputFile {
 public:
  /// Opens without waiting. Throws Error, naming the file and the reason, unless it is a regular file that can be read.
  explicit InputFile(std::filesystem::path path);
  ~InputFile();
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  /// Bytes that it had when it was opened.
  std::uint64_t size() const noexcept { return size_; }
  /// Fills `bytes` from where the last call ended. Returns how many bytes there were; fewer than asked for only at the
  /// end. Throws Error.
  std::size_t read(std::span<char> bytes);

 private:
  std::filesystem::path path_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
};

/// The whole of a file. Throws Error as InputFile does, and when it has more than `most` bytes.
std::string read_bytes(const std::filesystem::path& path, std::uint64_t most);

/// For files that a library opens by name. Throws Error as InputFile does.
void check_input(const std::filesystem::path& path);

}  // namespace tandem
