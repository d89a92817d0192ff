#include "pathtracer/load/gltf/uri.hpp"

#include <algorithm>
#include <cstdint>

#include "base/error.hpp"

namespace tandem::pathtracer {
namespace {

int hexadecimal(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

int base64_digit(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  if (c == '+' || c == '-') return 62;
  return c == '/' || c == '_' ? 63 : -1;
}

std::vector<unsigned char> base64_decoded(std::string_view text) {
  while (!text.empty() && text.back() == '=') text.remove_suffix(1);
  std::vector<unsigned char> bytes;
  bytes.reserve(text.size() / 4 * 3 + 2);
  std::uint32_t group = 0;
  int bits = 0;
  for (const char c : text) {
    const int digit = base64_digit(c);
    if (digit < 0) throw Error("its data URI is not base64");
    group = (group << 6 | static_cast<std::uint32_t>(digit)) & 0xffffffu;
    bits += 6;
    if (bits < 8) continue;
    bits -= 8;
    bytes.push_back(static_cast<unsigned char>(group >> bits & 255u));
  }
  // A single digit is less than a byte.
  if (bits == 6) throw Error("its data URI is not base64");
  return bytes;
}

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

bool has_prefix(std::string_view text, std::string_view lower) {
  return text.size() >= lower.size() && std::equal(lower.begin(), lower.end(), text.begin(),
                                                   [](char a, char b) { return a == (is_letter(b) ? b | 32 : b); });
}

}  // namespace

std::string percent_decoded(std::string_view text) {
  std::string result;
  result.reserve(text.size());
  for (std::size_t i = 0; i < text.size(); ++i) {
    const int high = text[i] == '%' && i + 2 < text.size() ? hexadecimal(text[i + 1]) : -1;
    const int low = high >= 0 ? hexadecimal(text[i + 2]) : -1;
    if (low < 0) {
      result += text[i];
      continue;
    }
    result += static_cast<char>(16 * high + low);
    i += 2;
  }
  return result;
}

bool is_data_uri(std::string_view uri) { return has_prefix(uri, "data:"); }

std::optional<std::vector<unsigned char>> data_uri_bytes(std::string_view uri) {
  if (!is_data_uri(uri)) return std::nullopt;
  const std::size_t comma = uri.find(',');
  if (comma == std::string_view::npos) throw Error("its data URI has no comma before its data");
  constexpr std::string_view mark = ";base64";
  const std::string_view type = uri.substr(0, comma);
  const std::string_view data = uri.substr(comma + 1);
  if (type.size() < mark.size() || !has_prefix(type.substr(type.size() - mark.size()), mark)) {
    const std::string decoded = percent_decoded(data);
    return std::vector<unsigned char>(decoded.begin(), decoded.end());
  }
  return data.find('%') == std::string_view::npos ? base64_decoded(data) : base64_decoded(percent_decoded(data));
}

std::string_view uri_scheme(std::string_view uri) {
  const std::size_t colon = uri.find(':');
  // One letter is a drive of Windows, no scheme.
  if (colon == std::string_view::npos || colon < 2 || !is_letter(uri[0])) return {};
  const auto is_of_scheme = [](char c) {
    return is_letter(c) || (c >= '0' && c <= '9') || c == '+' || c == '-' || c == '.';
  };
  return std::all_of(uri.begin(), uri.begin() + static_cast<std::ptrdiff_t>(colon), is_of_scheme) ? uri.substr(0, colon)
                                                                                                  : std::string_view();
}

}  // namespace tandem::pathtracer
