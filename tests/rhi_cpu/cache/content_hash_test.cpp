#include "rhi_cpu/cache/content_hash.hpp"

#include <doctest/doctest.h>

namespace tandem::cpu {

TEST_CASE("A content hash is that of XXH3") {
  // The value of XXH3_128bits with seed 0 and no input, as the xxHash specification's reference gives it: a changed
  // algorithm would orphan every cache.
  CHECK(content_hash({}).hex() == "99aa06d3014798d86001c324468d497f");
}

TEST_CASE("Hashed parts keep their borders") {
  using std::string_view;
  CHECK(ContentHasher().add(string_view("ab")).add(string_view("c")).hash() !=
        ContentHasher().add(string_view("a")).add(string_view("bc")).hash());
  CHECK(ContentHasher().add(string_view("ab")).hash() == ContentHasher().add(string_view("ab")).hash());
  CHECK(ContentHasher().add(std::uint64_t{1}).hash() != ContentHasher().add(std::uint64_t{2}).hash());
}

}  // namespace tandem::cpu
