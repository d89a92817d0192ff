#include "pathtracer/load/gltf/container.hpp"

#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <span>
#include <string_view>

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/input_file.hpp"

namespace tandem::pathtracer {
namespace {

using Bytes = std::span<const unsigned char>;

/// Of objects in objects: what reads them goes down by recursion.
constexpr int deepest_nesting = 256;

std::uint64_t word_at(Bytes bytes, std::size_t offset) {
  return bytes[offset] | std::uint64_t{bytes[offset + 1]} << 8 | std::uint64_t{bytes[offset + 2]} << 16 |
         std::uint64_t{bytes[offset + 3]} << 24;
}

bool is_binary(Bytes bytes) { return bytes.size() >= 4 && std::memcmp(bytes.data(), "glTF", 4) == 0; }

struct Chunks {
  Bytes json;
  Bytes data;
};

/// The chunks of a binary file; those of unknown types are skipped, as section 4.4.3 demands.
Chunks split(const std::string& path, Bytes bytes) {
  const auto fail = [&](std::string_view sentence) { return Error(fmt::format("{}: {}", path, sentence)); };
  constexpr std::size_t header = 12, chunk_header = 8;
  constexpr std::uint64_t json_type = 0x4E4F534A, data_type = 0x004E4942;
  if (bytes.size() < header + chunk_header) throw fail("the binary glTF file is cut off in its header");
  if (word_at(bytes, 4) != 2) throw fail(fmt::format("version {} of binary glTF is not 2", word_at(bytes, 4)));
  if (word_at(bytes, 8) > bytes.size())
    throw fail(fmt::format("the binary glTF file is cut off: {} bytes of {}", bytes.size(), word_at(bytes, 8)));
  if (word_at(bytes, header + 4) != json_type) throw fail("the first chunk of the binary glTF file is not JSON");
  Chunks chunks;
  bool is_first = true;
  for (std::size_t begin = header; begin + chunk_header <= bytes.size(); is_first = false) {
    const std::uint64_t size = word_at(bytes, begin);
    const std::uint64_t type = word_at(bytes, begin + 4);
    begin += chunk_header;
    if (size > bytes.size() - begin)
      throw fail(fmt::format("the {} of the binary glTF file is cut off", is_first ? "JSON" : "data"));
    const Bytes content = bytes.subspan(begin, static_cast<std::size_t>(size));
    if (is_first) chunks.json = content;
    if (!is_first && type == data_type && chunks.data.empty()) chunks.data = content;
    begin += content.size();
  }
  return chunks;
}

bool nests_too_deep(Bytes json) {
  int depth = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < json.size(); ++i) {
    const unsigned char c = json[i];
    if (in_string) {
      if (c == '\\') ++i;
      if (c == '"') in_string = false;
    } else if (c == '"') {
      in_string = true;
    } else if (c == '{' || c == '[') {
      if (++depth > deepest_nesting) return true;
    } else if (c == '}' || c == ']') {
      --depth;
    }
  }
  return false;
}

nlohmann::json parse(const std::string& path, Bytes text) {
  if (nests_too_deep(text))
    throw Error(fmt::format("{}: objects are nested deeper than {} times", path, deepest_nesting));
  try {
    return nlohmann::json::parse(text.begin(), text.end());
  } catch (const nlohmann::json::parse_error& error) {
    throw Error(fmt::format("{}: not a glTF file: its JSON has an error at byte {}", path, error.byte));
  } catch (const nlohmann::json::exception&) {
    throw Error(fmt::format("{}: a number in its JSON is too large to be read", path));
  }
}

}  // namespace

std::vector<unsigned char> read_gltf_bytes(const std::filesystem::path& path) {
  constexpr std::uint64_t most = 0xffffffff;  // what a .glb can hold
  const std::string text = tandem::read_bytes(path, most);
  std::vector<unsigned char> bytes(text.begin(), text.end());
  if (bytes.empty()) throw Error(fmt::format("'{}' is empty", path.string()));
  return bytes;
}

GltfContainer read_gltf_container(const std::filesystem::path& path) {
  const std::vector<unsigned char> bytes = read_gltf_bytes(path);
  if (!is_binary(bytes)) return {.json = parse(path.string(), bytes), .data = {}};
  const Chunks chunks = split(path.string(), bytes);
  return {.json = parse(path.string(), chunks.json), .data = {chunks.data.begin(), chunks.data.end()}};
}

}  // namespace tandem::pathtracer
