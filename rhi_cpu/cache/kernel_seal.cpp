#include "rhi_cpu/cache/kernel_seal.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <optional>
#include <span>
#include <vector>

namespace tandem::cpu {
namespace {

struct Seal {
  std::array<char, 8> magic = {'T', 'a', 'n', 'd', 'e', 'm', 'K', '1'};
  ContentHash key;
  ContentHash content;

  bool operator==(const Seal&) const = default;
};
static_assert(sizeof(Seal) == 40);

/// The whole file; nothing when it cannot be read or shrinks meanwhile.
std::optional<std::vector<std::byte>> read_file(int file) {
  struct stat status {};
  if (::fstat(file, &status) != 0 || !S_ISREG(status.st_mode)) return std::nullopt;
  std::vector<std::byte> content(static_cast<std::size_t>(status.st_size));
  std::size_t done = 0;
  while (done < content.size()) {
    const ssize_t count = ::pread(file, content.data() + done, content.size() - done, static_cast<off_t>(done));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return std::nullopt;
    done += static_cast<std::size_t>(count);
  }
  return content;
}

bool append(int file, std::size_t size, std::span<const std::byte> bytes) {
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t count = ::pwrite(file, bytes.data() + done, bytes.size() - done, static_cast<off_t>(size + done));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    done += static_cast<std::size_t>(count);
  }
  return true;
}

Seal make_seal(std::span<const std::byte> content, const ContentHash& key) {
  Seal seal;
  seal.key = key;
  seal.content = content_hash(content);
  return seal;
}

}  // namespace

bool seal_kernel_file(int file, const ContentHash& key) {
  const std::optional<std::vector<std::byte>> content = read_file(file);
  if (!content) return false;
  const Seal seal = make_seal(*content, key);
  return append(file, content->size(), std::as_bytes(std::span(&seal, 1))) && ::fchmod(file, S_IRWXU) == 0;
}

bool kernel_file_is_sound(int file, const ContentHash& key) {
  const std::optional<std::vector<std::byte>> content = read_file(file);
  if (!content || content->size() < sizeof(Seal)) return false;
  const std::size_t size = content->size() - sizeof(Seal);
  Seal seal;
  std::memcpy(&seal, content->data() + size, sizeof(seal));
  return seal == make_seal(std::span(*content).first(size), key);
}

}  // namespace tandem::cpu
