#pragma once

#include <string>
#include <string_view>

namespace tandem::tools {

/// The text as it stands in an attribute or between the tags of XML or HTML. Line breaks and tabs are written as
/// references, since a parser makes spaces of them in attributes. What XML cannot hold (control characters, bytes that
/// are no UTF-8) becomes U+FFFD.
std::string xml_text(std::string_view text);

}  // namespace tandem::tools
