#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "pathtracer/scene/scene.hpp"

namespace tandem::test {

/// accessor.componentType (glTF 2.0, section 5.1.3).
inline constexpr int component_byte = 5120, component_unsigned_byte = 5121, component_short = 5122,
                     component_unsigned_short = 5123, component_unsigned_int = 5125, component_float = 5126;

/// A glTF file in the making: a scene of nodes over one buffer.
struct GltfFile {
  nlohmann::json json = {
      {"asset", {{"version", "2.0"}}}, {"scene", 0}, {"scenes", {{{"nodes", nlohmann::json::array()}}}}};
  std::vector<unsigned char> buffer;

  /// Each returns the index of what it adds.
  int add(const std::string& array, const nlohmann::json& object);
  int add_view(const void* bytes, std::size_t size, std::size_t stride = 0);
  template <class T>
  int add_accessor(const std::vector<T>& components, int component_type, const std::string& type,
                   bool normalized = false, std::size_t stride = 0);
  int add_vectors(const std::vector<float>& components, const std::string& type = "VEC3") {
    return add_accessor(components, component_float, type);
  }
  int add_indices(const std::vector<std::uint16_t>& indices) {
    return add_accessor(indices, component_unsigned_short, "SCALAR");
  }
  /// A root of the scene.
  int add_node(const nlohmann::json& node);
  /// A mesh of one primitive.
  int add_mesh(const nlohmann::json& primitive) { return add("meshes", {{"primitives", {primitive}}}); }
  /// The triangle (0, 0, 0), (1, 0, 0), (0, 1, 0) at a node of its own, with texture coordinates (0, 0), (1, 0), (0,
  /// 1).
  void add_triangle(const nlohmann::json& material = nullptr);

  std::string text() const;    ///< .gltf, with the buffer in it
  std::string binary() const;  ///< .glb
  pathtracer::Scene load() const;
  std::string error() const;  ///< of loading it; "no error"
};

/// A PNG file of four bytes per pixel, rows from the top.
std::vector<unsigned char> png(std::uint32_t width, std::uint32_t height, const std::vector<std::uint8_t>& pixels);

std::string data_uri(const std::string& type, const std::vector<unsigned char>& bytes);

bool contains(std::string_view text, std::string_view part);

template <class T>
int GltfFile::add_accessor(const std::vector<T>& components, int component_type, const std::string& type,
                           bool normalized, std::size_t stride) {
  const std::size_t count = type == "SCALAR" ? 1 : static_cast<std::size_t>(type.back() - '0');
  const std::size_t element = count * sizeof(T);
  std::vector<unsigned char> bytes;
  for (std::size_t i = 0; i < components.size() / count; ++i) {
    const auto* first = reinterpret_cast<const unsigned char*>(components.data()) + i * element;
    bytes.insert(bytes.end(), first, first + element);
    bytes.resize(i * (stride == 0 ? element : stride) + (stride == 0 ? element : stride));
  }
  const int view = add_view(bytes.data(), bytes.size(), stride);
  return add("accessors", {{"bufferView", view},
                           {"componentType", component_type},
                           {"count", components.size() / count},
                           {"type", type},
                           {"normalized", normalized}});
}

}  // namespace tandem::test
