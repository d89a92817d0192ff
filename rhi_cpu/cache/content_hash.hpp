#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace tandem::cpu {

/// 128 bits that stand for a content: equal contents have equal hashes, different ones practically never. It guards
/// against accidents, not against somebody who forges collisions.
struct ContentHash {
  std::uint64_t high = 0;
  std::uint64_t low = 0;

  auto operator<=>(const ContentHash&) const = default;
  /// 32 lower-case hexadecimal digits.
  std::string hex() const;
};

/// XXH3, 128 bits, seed 0.
ContentHash content_hash(std::span<const std::byte> content);

/// Collects parts and hashes them as a sequence, so that ("ab", "c") differs from ("a", "bc").
class ContentHasher {
 public:
  ContentHasher& add(std::span<const std::byte> part);
  ContentHasher& add(std::string_view part);
  ContentHasher& add(std::uint64_t part);
  ContentHash hash() const;

 private:
  std::string parts_;
};

}  // namespace tandem::cpu
