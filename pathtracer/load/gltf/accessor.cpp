#include "pathtracer/load/gltf/accessor.hpp"

#include <algorithm>
#include <cstring>
#include <limits>
#include <string>

#include <fmt/format.h>

namespace tandem::pathtracer {
namespace {

/// Of an accessor without buffer view, whose elements are all 0: nothing else bounds the memory that it takes.
constexpr std::size_t largest_empty_accessor = std::size_t{1} << 26;

std::size_t component_size(int type) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return 1;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return 2;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
      return 4;
    default:
      return 0;
  }
}

std::size_t component_count(int type) {
  switch (type) {
    case TINYGLTF_TYPE_SCALAR:
      return 1;
    case TINYGLTF_TYPE_VEC2:
      return 2;
    case TINYGLTF_TYPE_VEC3:
      return 3;
    case TINYGLTF_TYPE_VEC4:
      return 4;
    case TINYGLTF_TYPE_MAT4:
      return 16;
    default:
      return 0;
  }
}

/// Elements in a buffer view, all of them inside it.
struct Elements {
  const unsigned char* first = nullptr;
  std::size_t stride = 0;  ///< bytes from one to the next
};

Elements elements(const GltfDocument& document, int buffer_view, std::uint64_t offset, std::size_t count,
                  std::size_t element_size, std::string_view owner) {
  const std::span<const unsigned char> view = gltf_view(document, buffer_view, owner);
  const std::size_t given = document.model.bufferViews[static_cast<std::size_t>(buffer_view)].byteStride;
  const std::size_t stride = given == 0 ? element_size : given;
  if (stride < element_size)
    throw gltf_error(document, owner, fmt::format("its elements of {} bytes are {} apart", element_size, stride));
  // No product: the file may make it overflow.
  if (count > 0 && (offset > view.size() || element_size > view.size() - offset ||
                    (count - 1) > (view.size() - offset - element_size) / stride))
    throw gltf_error(
        document, owner,
        fmt::format("{} elements reach beyond the {} bytes of buffer view {}", count, view.size(), buffer_view));
  return {view.data() + offset, stride};
}

template <class T>
T load(const unsigned char* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof(T));
  return value;
}

template <class T>
float decode(const unsigned char* bytes, bool normalized) {
  const auto value = static_cast<float>(load<T>(bytes));
  return normalized ? std::max(value / static_cast<float>(std::numeric_limits<T>::max()), -1.0f) : value;
}

float decode(const unsigned char* bytes, int type, bool normalized) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return decode<std::int8_t>(bytes, normalized);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return decode<std::uint8_t>(bytes, normalized);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return decode<std::int16_t>(bytes, normalized);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return decode<std::uint16_t>(bytes, normalized);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return decode<std::uint32_t>(bytes, normalized);
    default:
      return load<float>(bytes);
  }
}

std::uint32_t decode_index(const unsigned char* bytes, int type) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return *bytes;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return load<std::uint16_t>(bytes);
    default:
      return load<std::uint32_t>(bytes);
  }
}

std::vector<std::uint32_t> read_indices(const Elements& source, std::size_t count, int type) {
  std::vector<std::uint32_t> indices(count);
  for (std::size_t i = 0; i < count; ++i) indices[i] = decode_index(source.first + i * source.stride, type);
  return indices;
}

void check_indices(const GltfDocument& document, const std::vector<std::uint32_t>& indices, std::size_t limit,
                   std::string_view owner) {
  for (std::size_t i = 0; i < indices.size(); ++i)
    if (indices[i] >= limit)
      throw gltf_error(document, owner,
                       fmt::format("index {} is {}, but there are only {} elements", i, indices[i], limit));
}

bool is_index_type(int type) {
  return type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE || type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
         type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
}

/// What the sparse part of an accessor puts where.
struct Substitutes {
  std::vector<std::uint32_t> places;
  Elements values;
};

Substitutes substitutes(const GltfDocument& document, const tinygltf::Accessor& accessor, std::size_t element_size,
                        std::string_view owner) {
  const auto count = static_cast<std::size_t>(accessor.sparse.count);
  const int index_type = accessor.sparse.indices.componentType;
  if (accessor.sparse.count < 0 || count > accessor.count || !is_index_type(index_type))
    throw gltf_error(document, owner, "its sparse part has a wrong count or type of index");
  const Elements index_source = elements(document, accessor.sparse.indices.bufferView,
                                         static_cast<std::uint64_t>(accessor.sparse.indices.byteOffset), count,
                                         component_size(index_type), owner);
  Substitutes result{
      .places = read_indices(index_source, count, index_type),
      .values = elements(document, accessor.sparse.values.bufferView,
                         static_cast<std::uint64_t>(accessor.sparse.values.byteOffset), count, element_size, owner)};
  check_indices(document, result.places, accessor.count, owner);
  return result;
}

void check_without_data(const GltfDocument& document, const tinygltf::Accessor& accessor, std::string_view owner) {
  if (accessor.count > largest_empty_accessor)
    throw gltf_error(document, owner, fmt::format("has {} elements and no data", accessor.count));
}

std::string accessor_name(int index, const tinygltf::Accessor& accessor) {
  return gltf_name("accessor", static_cast<std::size_t>(index), accessor.name);
}

}  // namespace

GltfValues gltf_vectors(const GltfDocument& document, int index, std::size_t least, std::size_t most,
                        std::string_view owner) {
  const tinygltf::Accessor& accessor = gltf_at(document, document.model.accessors, index, "accessor", owner);
  const std::string name = accessor_name(index, accessor);
  const std::size_t size = component_size(accessor.componentType);
  GltfValues result{.count = accessor.count, .components = component_count(accessor.type), .values = {}};
  if (size == 0 || result.components < least || result.components > most)
    throw gltf_error(document, name, fmt::format("is not of the type that {} needs", owner));
  if (accessor.bufferView < 0) {
    check_without_data(document, accessor, name);
    result.values.resize(result.count * result.components);
  } else {
    const Elements source =
        elements(document, accessor.bufferView, accessor.byteOffset, accessor.count, size * result.components, name);
    result.values.reserve(result.count * result.components);
    for (std::size_t i = 0; i < result.count; ++i)
      for (std::size_t component = 0; component < result.components; ++component)
        result.values.push_back(
            decode(source.first + i * source.stride + component * size, accessor.componentType, accessor.normalized));
  }
  if (!accessor.sparse.isSparse) return result;
  const Substitutes sparse = substitutes(document, accessor, size * result.components, name);
  for (std::size_t i = 0; i < sparse.places.size(); ++i)
    for (std::size_t component = 0; component < result.components; ++component)
      result.values[sparse.places[i] * result.components + component] =
          decode(sparse.values.first + i * sparse.values.stride + component * size, accessor.componentType,
                 accessor.normalized);
  return result;
}

std::vector<std::uint32_t> gltf_indices(const GltfDocument& document, int index, std::size_t limit,
                                        std::string_view owner) {
  const tinygltf::Accessor& accessor = gltf_at(document, document.model.accessors, index, "accessor", owner);
  const std::string name = accessor_name(index, accessor);
  if (accessor.type != TINYGLTF_TYPE_SCALAR || !is_index_type(accessor.componentType))
    throw gltf_error(document, name, "does not hold unsigned integers, as indices must be");
  const std::size_t size = component_size(accessor.componentType);
  std::vector<std::uint32_t> indices;
  if (accessor.bufferView < 0) {
    check_without_data(document, accessor, name);
    indices.resize(accessor.count);
  } else {
    indices = read_indices(elements(document, accessor.bufferView, accessor.byteOffset, accessor.count, size, name),
                           accessor.count, accessor.componentType);
  }
  if (accessor.sparse.isSparse) {
    const Substitutes sparse = substitutes(document, accessor, size, name);
    for (std::size_t i = 0; i < sparse.places.size(); ++i)
      indices[sparse.places[i]] = decode_index(sparse.values.first + i * sparse.values.stride, accessor.componentType);
  }
  check_indices(document, indices, limit, name);
  return indices;
}

}  // namespace tandem::pathtracer
