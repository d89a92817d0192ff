#include "rhi_cpu/cache/content_hash.hpp"

#include <fmt/format.h>

// Inlined, so that programs which use Tandem need no xxhash library.
#define XXH_INLINE_ALL
#include <xxhash.h>

namespace tandem::cpu {

std::string ContentHash::hex() const { return fmt::format("{:016x}{:016x}", high, low); }

ContentHash content_hash(std::span<const std::byte> content) {
  const XXH128_hash_t hash = XXH3_128bits(content.data(), content.size());
  return {.high = hash.high64, .low = hash.low64};
}

ContentHasher& ContentHasher::add(std::span<const std::byte> part) {
  return add(std::string_view(reinterpret_cast<const char*>(part.data()), part.size()));
}

ContentHasher& ContentHasher::add(std::string_view part) {
  add(std::uint64_t{part.size()});
  parts_ += part;
  return *this;
}

ContentHasher& ContentHasher::add(std::uint64_t part) {
  parts_.append(reinterpret_cast<const char*>(&part), sizeof(part));
  return *this;
}

ContentHash ContentHasher::hash() const { return content_hash(std::as_bytes(std::span(parts_))); }

}  // namespace tandem::cpu
