#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tandem::pathtracer {

/// A text whose "%41" stand for characters (RFC 3986, section 2.1). A percent sign without two digits is one.
std::string percent_decoded(std::string_view text);

bool is_data_uri(std::string_view uri);

/// The bytes that a data URI holds (RFC 2397), in base64 or percent-encoded; nothing for another URI. Throws Error with
/// half a sentence, such as "its data URI is not base64", for data that are none.
std::optional<std::vector<unsigned char>> data_uri_bytes(std::string_view uri);

/// "http" of a URI that names a scheme other than a data URI; empty for a relative reference.
std::string_view uri_scheme(std::string_view uri);

}  // namespace tandem::pathtracer
