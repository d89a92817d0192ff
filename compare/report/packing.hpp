#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

/// How a page of HTML carries what is not text.
namespace tandem::compare {

/// zlib's format (RFC 1950) in base64 (RFC 4648): a browser undoes it by atob and DecompressionStream("deflate").
std::string packed(std::span<const std::uint8_t> bytes);
std::string packed(const std::string& text);

/// As bytes, lowest first.
std::string packed(std::span<const std::uint32_t> words);

}  // namespace tandem::compare
