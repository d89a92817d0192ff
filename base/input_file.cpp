#include "base/input_file.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <string_view>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/error.hpp"

namespace tandem {
namespace {

Error read_error(const std::filesystem::path& path, std::string_view why) {
  return Error(fmt::format("cannot read '{}': {}", path.string(), why));
}

/// What a file is instead of a regular one; nullptr for a regular one.
const char* other_kind(mode_t mode) {
  if (S_ISREG(mode)) return nullptr;
  if (S_ISDIR(mode)) return "it is a folder";
  if (S_ISFIFO(mode)) return "it is a pipe, not a regular file";
  if (S_ISSOCK(mode)) return "it is a socket, not a regular file";
  return "it is a device, not a regular file";
}

std::string reason_of(int error) {
  if (error == ENOENT) return "it does not exist";
  if (error == ENXIO) return "it is a socket, not a regular file";
  return std::strerror(error);
}

}  // namespace

InputFile::InputFile(std::filesystem::path path) : path_(std::move(path)) {
  // A pipe without a writer would block an ordinary open, and a terminal become this program's own.
  descriptor_ = ::open(path_.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY);
  if (descriptor_ < 0) throw read_error(path_, reason_of(errno));
  struct stat status {};
  const bool known = ::fstat(descriptor_, &status) == 0;
  const int error = errno;
  const char* const other = known ? other_kind(status.st_mode) : nullptr;
  if (!known || other != nullptr) {
    ::close(descriptor_);
    throw read_error(path_, known ? other : std::strerror(error));
  }
  size_ = static_cast<std::uint64_t>(status.st_size);
}

InputFile::~InputFile() { ::close(descriptor_); }

std::size_t InputFile::read(std::span<char> bytes) {
  std::size_t count = 0;
  while (count < bytes.size()) {
    const ssize_t result = ::read(descriptor_, bytes.data() + count, bytes.size() - count);
    if (result < 0 && errno == EINTR) continue;
    if (result < 0) throw read_error(path_, std::strerror(errno));
    if (result == 0) break;
    count += static_cast<std::size_t>(result);
  }
  return count;
}

std::string read_bytes(const std::filesystem::path& path, std::uint64_t most) {
  InputFile file(path);
  const auto too_large = [&] { return read_error(path, fmt::format("it has more than {} bytes", most)); };
  if (file.size() > most) throw too_large();
  // One more than it says, to see its end; the files of /proc say 0.
  std::string bytes;
  std::size_t count = 0;
  std::uint64_t room = std::max<std::uint64_t>(file.size(), 4096) + 1;
  do {
    bytes.resize(static_cast<std::size_t>(room));
    count += file.read(std::span(bytes).subspan(count));
    if (count > most) throw too_large();
    room *= 2;
  } while (count == bytes.size());
  bytes.resize(count);
  return bytes;
}

void check_input(const std::filesystem::path& path) { const InputFile file(path); }

}  // namespace tandem
