#include "rhi_cpu/cache/kernel_seal.hpp"

#include <array>
#include <cstring>
#include <fstream>
#include <optional>
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

std::optional<std::vector<std::byte>> read_file(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  if (!file) return std::nullopt;
  std::vector<std::byte> content(static_cast<std::size_t>(file.tellg()));
  file.seekg(0);
  file.read(reinterpret_cast<char*>(content.data()), static_cast<std::streamsize>(content.size()));
  if (!file) return std::nullopt;
  return content;
}

Seal make_seal(std::span<const std::byte> content, const ContentHash& key) {
  Seal seal;
  seal.key = key;
  seal.content = content_hash(content);
  return seal;
}

}  // namespace

bool seal_kernel_file(const std::filesystem::path& path, const ContentHash& key) {
  const std::optional<std::vector<std::byte>> content = read_file(path);
  if (!content) return false;
  const Seal seal = make_seal(*content, key);
  std::ofstream file(path, std::ios::binary | std::ios::app);
  file.write(reinterpret_cast<const char*>(&seal), sizeof(seal));
  file.close();
  return !file.fail();
}

bool kernel_file_is_sound(const std::filesystem::path& path, const ContentHash& key) {
  const std::optional<std::vector<std::byte>> content = read_file(path);
  if (!content || content->size() < sizeof(Seal)) return false;
  const std::size_t size = content->size() - sizeof(Seal);
  Seal seal;
  std::memcpy(&seal, content->data() + size, sizeof(seal));
  return seal == make_seal(std::span(*content).first(size), key);
}

}  // namespace tandem::cpu
