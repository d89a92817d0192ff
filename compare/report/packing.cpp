#include "compare/report/packing.hpp"

#include <zlib.h>

#include <stdexcept>
#include <vector>

#include "base/base64.hpp"

namespace tandem::compare {
namespace {

std::vector<std::uint8_t> compressed(std::span<const std::uint8_t> bytes) {
  uLongf size = compressBound(bytes.size());
  std::vector<std::uint8_t> result(size);
  if (compress2(result.data(), &size, bytes.data(), bytes.size(), Z_DEFAULT_COMPRESSION) != Z_OK)
    throw std::runtime_error("zlib cannot compress what a report shows");
  result.resize(size);
  return result;
}

}  // namespace

std::string packed(std::span<const std::uint8_t> bytes) {
  const std::vector<std::uint8_t> small = compressed(bytes);
  return base64(std::as_bytes(std::span(small)));
}

std::string packed(const std::string& text) { return packed(std::vector<std::uint8_t>(text.begin(), text.end())); }

std::string packed(std::span<const std::uint32_t> words) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(4 * words.size());
  for (const std::uint32_t word : words)
    for (unsigned shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<std::uint8_t>(word >> shift));
  return packed(bytes);
}

}  // namespace tandem::compare
