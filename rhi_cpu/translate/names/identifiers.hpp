#pragma once

#include <string>
#include <string_view>

namespace tandem::cpu {

/// `name` where C++ can use it for a local variable or member, so that a debugger shows the GLSL's own name; else the
/// name with an underscore appended. All capitals are taken for macros.
std::string identifier(std::string_view name);

/// `text` as the content of a C++ string literal.
std::string escaped(std::string_view text);

}  // namespace tandem::cpu
