#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "pathtracer/load/gltf/document.hpp"

namespace tandem::pathtracer {

/// The elements of an accessor, one after the other.
struct GltfValues {
  std::size_t count = 0;
  std::size_t components = 1;  ///< of each element
  std::vector<float> values;   ///< count * components of them
};

/// Reads vectors, or matrices of 16 components, of any component type, normalised integers as glTF 2.0 (section 3.11)
/// decodes them, with sparse substitution. Throws Error, naming the accessor, when it is no vector of `least` to `most`
/// components or reaches beyond its buffer view. @param owner what refers to the accessor
GltfValues gltf_vectors(const GltfDocument& document, int accessor, std::size_t least, std::size_t most,
                        std::string_view owner);

/// Reads unsigned integers, with sparse substitution. Throws Error likewise, and where one is not below `limit`.
std::vector<std::uint32_t> gltf_indices(const GltfDocument& document, int accessor, std::size_t limit,
                                        std::string_view owner);

}  // namespace tandem::pathtracer
