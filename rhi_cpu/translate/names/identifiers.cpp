#include "rhi_cpu/translate/names/identifiers.hpp"

#include <algorithm>
#include <iterator>

namespace tandem::cpu {
namespace {

/// Sorted. C++ keywords, and lower-case macros of the C library.
constexpr std::string_view taken[] = {"alignas",
                                      "alignof",
                                      "and",
                                      "and_eq",
                                      "asm",
                                      "assert",
                                      "auto",
                                      "bitand",
                                      "bitor",
                                      "bool",
                                      "break",
                                      "case",
                                      "catch",
                                      "char",
                                      "char16_t",
                                      "char32_t",
                                      "char8_t",
                                      "class",
                                      "co_await",
                                      "co_return",
                                      "co_yield",
                                      "compl",
                                      "concept",
                                      "const",
                                      "const_cast",
                                      "consteval",
                                      "constexpr",
                                      "constinit",
                                      "continue",
                                      "decltype",
                                      "default",
                                      "delete",
                                      "do",
                                      "double",
                                      "dynamic_cast",
                                      "else",
                                      "enum",
                                      "errno",
                                      "explicit",
                                      "export",
                                      "extern",
                                      "false",
                                      "float",
                                      "for",
                                      "friend",
                                      "goto",
                                      "if",
                                      "inline",
                                      "int",
                                      "linux",
                                      "long",
                                      "mutable",
                                      "namespace",
                                      "new",
                                      "noexcept",
                                      "not",
                                      "not_eq",
                                      "nullptr",
                                      "offsetof",
                                      "operator",
                                      "or",
                                      "or_eq",
                                      "private",
                                      "protected",
                                      "public",
                                      "register",
                                      "reinterpret_cast",
                                      "requires",
                                      "return",
                                      "setjmp",
                                      "short",
                                      "signed",
                                      "sizeof",
                                      "static",
                                      "static_assert",
                                      "static_cast",
                                      "stderr",
                                      "stdin",
                                      "stdout",
                                      "struct",
                                      "switch",
                                      "template",
                                      "this",
                                      "thread_local",
                                      "throw",
                                      "true",
                                      "try",
                                      "typedef",
                                      "typeid",
                                      "typename",
                                      "union",
                                      "unix",
                                      "unsigned",
                                      "using",
                                      "va_arg",
                                      "va_copy",
                                      "va_end",
                                      "va_start",
                                      "virtual",
                                      "void",
                                      "volatile",
                                      "wchar_t",
                                      "while",
                                      "xor",
                                      "xor_eq"};

/// What the printer itself begins names with, followed by more.
constexpr std::string_view own_prefixes[] = {"block_",          "built_in_", "constant_", "function_",
                                             "hit_attributes_", "load_",     "payload_",  "private_",
                                             "rounds_",         "shared_",   "store_",    "struct_"};
constexpr std::string_view own_names[] = {
    "binding_slots", "call",           "ended",     "entry_point", "kernel_info", "Invocation",   "own_group",
    "own_lane",      "push_constants", "resources", "run",         "shader_call", "shader_record"};

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_upper(char c) { return c >= 'A' && c <= 'Z'; }
bool is_letter(char c) { return is_upper(c) || (c >= 'a' && c <= 'z'); }

}  // namespace

std::string identifier(std::string_view name) {
  std::string result;
  for (const char c : name) {
    const char clean = is_letter(c) || is_digit(c) ? c : '_';
    if (clean == '_' && (result.empty() || result.back() == '_'))
      continue;  // names with __ or a leading _ are reserved
    result += clean;
  }
  if (result.empty() || is_digit(result[0])) result = "n" + result;
  const bool macro_like = std::none_of(result.begin(), result.end(), [](char c) { return c >= 'a' && c <= 'z'; });
  const bool own = std::any_of(std::begin(own_prefixes), std::end(own_prefixes),
                               [&](std::string_view prefix) { return result.starts_with(prefix); }) ||
                   std::find(std::begin(own_names), std::end(own_names), result) != std::end(own_names);
  if (result.back() != '_' && (macro_like || own || std::binary_search(std::begin(taken), std::end(taken), result)))
    result += '_';
  return result;
}

std::string escaped(std::string_view text) {
  std::string result;
  for (const char c : text) {
    if (c == '\\' || c == '"') result += '\\';
    result += c == '\n' || c == '\r' ? ' ' : c;
  }
  return result;
}

}  // namespace tandem::cpu
