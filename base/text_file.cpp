#include "base/text_file.hpp"

#include <string_view>

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/input_file.hpp"

namespace tandem {
namespace {

constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";

}  // namespace

std::string read_text(const std::filesystem::path& path) {
  InputFile file(path);
  std::string text;
  std::string chunk(std::size_t{1} << 20, '\0');
  for (std::size_t count = chunk.size(); count == chunk.size();) {
    count = file.read(chunk);
    const std::string_view read(chunk.data(), count);
    // At once, so that a large binary file is not read to its end.
    if (read.find('\0') != std::string_view::npos) throw Error(fmt::format("'{}' is not a text file", path.string()));
    text += read;
  }
  if (text.starts_with(byte_order_mark)) text.erase(0, byte_order_mark.size());
  if (text.empty()) throw Error(fmt::format("'{}' is empty", path.string()));
  return text;
}

}  // namespace tandem
