#include "tests/pathtracer/load/gltf/file.hpp"

#include <array>

#include "base/error.hpp"
#include "pathtracer/load/gltf/loader.hpp"
#include "tests/support/scratch_folder.hpp"

namespace tandem::test {
namespace {

std::string base64(const std::vector<unsigned char>& bytes) {
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) group = group << 8 | (i + k < bytes.size() ? bytes[i + k] : 0u);
    for (std::size_t k = 0; k < 4; ++k) text += i + k > bytes.size() ? '=' : digits[group >> (18 - 6 * k) & 63];
  }
  return text;
}

void append_word(std::string& bytes, std::size_t word) {
  for (int shift = 0; shift < 32; shift += 8) bytes += static_cast<char>(word >> shift & 255);
}

void append_word_big_endian(std::vector<unsigned char>& bytes, std::uint32_t word) {
  for (int shift = 24; shift >= 0; shift -= 8) bytes.push_back(static_cast<unsigned char>(word >> shift & 255));
}

std::uint32_t crc32(const std::vector<unsigned char>& bytes) {
  std::uint32_t crc = 0xffffffffu;
  for (const unsigned char byte : bytes) {
    crc ^= byte;
    for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ ((crc & 1) != 0 ? 0xedb88320u : 0u);
  }
  return ~crc;
}

void append_chunk(std::vector<unsigned char>& file, std::string_view type, const std::vector<unsigned char>& data) {
  std::vector<unsigned char> checked(type.begin(), type.end());
  checked.insert(checked.end(), data.begin(), data.end());
  append_word_big_endian(file, static_cast<std::uint32_t>(data.size()));
  file.insert(file.end(), checked.begin(), checked.end());
  append_word_big_endian(file, crc32(checked));
}

/// Stored without compression, as zlib (RFC 1950 and 1951) allows.
std::vector<unsigned char> zlib(const std::vector<unsigned char>& data) {
  std::vector<unsigned char> result{0x78, 0x01, 1};
  const std::size_t size = data.size();
  for (const std::size_t half : {size, ~size})
    for (const int shift : {0, 8}) result.push_back(static_cast<unsigned char>(half >> shift & 255));
  result.insert(result.end(), data.begin(), data.end());
  std::uint32_t a = 1, b = 0;
  for (const unsigned char byte : data) {
    a = (a + byte) % 65521;
    b = (b + a) % 65521;
  }
  append_word_big_endian(result, b << 16 | a);
  return result;
}

}  // namespace

int GltfFile::add(const std::string& array, const nlohmann::json& object) {
  json[array].push_back(object);
  return static_cast<int>(json[array].size()) - 1;
}

int GltfFile::add_view(const void* bytes, std::size_t size, std::size_t stride) {
  buffer.resize((buffer.size() + 3) / 4 * 4);
  nlohmann::json view = {{"buffer", 0}, {"byteOffset", buffer.size()}, {"byteLength", size}};
  if (stride > 0) view["byteStride"] = stride;
  const auto* first = static_cast<const unsigned char*>(bytes);
  buffer.insert(buffer.end(), first, first + size);
  return add("bufferViews", view);
}

int GltfFile::add_node(const nlohmann::json& node) {
  const int index = add("nodes", node);
  json["scenes"][0]["nodes"].push_back(index);
  return index;
}

void GltfFile::add_triangle(const nlohmann::json& material) {
  nlohmann::json primitive = {{"attributes",
                               {{"POSITION", add_vectors({0, 0, 0, 1, 0, 0, 0, 1, 0})},
                                {"TEXCOORD_0", add_vectors({0, 0, 1, 0, 0, 1}, "VEC2")}}}};
  if (!material.is_null()) primitive["material"] = add("materials", material);
  add_node({{"mesh", add_mesh(primitive)}});
}

std::string GltfFile::text() const {
  nlohmann::json whole = json;
  if (!buffer.empty() && !whole.contains("buffers"))
    whole["buffers"] = {{{"byteLength", buffer.size()}, {"uri", data_uri("application/octet-stream", buffer)}}};
  return whole.dump();
}

std::string GltfFile::binary() const {
  nlohmann::json whole = json;
  std::vector<unsigned char> data = buffer;
  whole["buffers"] = {{{"byteLength", data.size()}}};
  data.resize((data.size() + 3) / 4 * 4);
  std::string text = whole.dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  std::string file = "glTF";
  append_word(file, 2);
  append_word(file, 12 + 8 + text.size() + 8 + data.size());
  append_word(file, text.size());
  file += "JSON" + text;
  append_word(file, data.size());
  file += std::string("BIN\0", 4) + std::string(data.begin(), data.end());
  return file;
}

pathtracer::Scene GltfFile::load() const {
  const ScratchFolder folder;
  return pathtracer::load_gltf(folder.write("test.gltf", text()));
}

std::string GltfFile::error() const {
  try {
    load();
  } catch (const tandem::Error& error) {
    return error.what();
  }
  return "no error";
}

std::vector<unsigned char> png(std::uint32_t width, std::uint32_t height, const std::vector<std::uint8_t>& pixels) {
  std::vector<unsigned char> header, rows;
  append_word_big_endian(header, width);
  append_word_big_endian(header, height);
  for (const unsigned char byte : std::array<unsigned char, 5>{8, 6, 0, 0, 0}) header.push_back(byte);
  for (std::size_t row = 0; row < height; ++row) {
    rows.push_back(0);
    const auto first = pixels.begin() + static_cast<std::ptrdiff_t>(4 * width * row);
    rows.insert(rows.end(), first, first + 4 * static_cast<std::ptrdiff_t>(width));
  }
  std::vector<unsigned char> file{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  append_chunk(file, "IHDR", header);
  append_chunk(file, "IDAT", zlib(rows));
  append_chunk(file, "IEND", {});
  return file;
}

std::string data_uri(const std::string& type, const std::vector<unsigned char>& bytes) {
  return "data:" + type + ";base64," + base64(bytes);
}

bool contains(std::string_view text, std::string_view part) { return text.find(part) != std::string_view::npos; }

}  // namespace tandem::test
