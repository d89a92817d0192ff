#include "base/text_file.hpp"

#include <fstream>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

#include "base/error.hpp"

namespace tandem {
namespace {

constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";

}  // namespace

std::string read_text(const std::filesystem::path& path) {
  std::error_code status_error;
  if (std::filesystem::is_directory(path, status_error))
    throw Error(fmt::format("cannot read '{}': it is a folder", path.string()));
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    const bool exists = std::filesystem::exists(path, status_error);
    throw Error(
        fmt::format("cannot read '{}': {}", path.string(), exists ? "it cannot be opened" : "it does not exist"));
  }
  std::string text;
  std::string chunk(std::size_t{1} << 20, '\0');
  do {
    file.read(chunk.data(), static_cast<std::streamsize>(chunk.size()));
    const std::string_view read(chunk.data(), static_cast<std::size_t>(file.gcount()));
    // At once, so that a large binary file or a device such as /dev/zero is not read to its end.
    if (read.find('\0') != std::string_view::npos) throw Error(fmt::format("'{}' is not a text file", path.string()));
    text += read;
  } while (file);
  if (file.bad()) throw Error(fmt::format("cannot read '{}': reading failed", path.string()));
  if (text.starts_with(byte_order_mark)) text.erase(0, byte_order_mark.size());
  if (text.empty()) throw Error(fmt::format("'{}' is empty", path.string()));
  return text;
}

}  // namespace tandem
