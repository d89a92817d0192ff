#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace tandem {

/// The bytes in base64 with padding (RFC 4648, section 4), as data URLs and JavaScript's atob take it.
std::string base64(std::span<const std::byte> bytes);

}  // namespace tandem
