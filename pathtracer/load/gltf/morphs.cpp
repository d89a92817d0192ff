#include "pathtracer/load/gltf/morphs.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "pathtracer/load/gltf/accessor.hpp"

namespace tandem::pathtracer {

void apply_gltf_morphs(const GltfDocument& document, const tinygltf::Primitive& source,
                       const std::vector<double>& weights, const std::string& attribute, std::string_view owner,
                       std::vector<glm::vec3>& vectors) {
  for (std::size_t target = 0; target < std::min(weights.size(), source.targets.size()); ++target) {
    const auto entry = source.targets[target].find(attribute);
    if (weights[target] == 0 || entry == source.targets[target].end()) continue;
    const GltfValues moves = gltf_vectors(document, entry->second, 3, 3, owner);
    if (moves.count != vectors.size())
      throw gltf_error(document, owner,
                       fmt::format("{} of morph target {} has {} elements, but there are {} vertices", attribute,
                                   target, moves.count, vectors.size()));
    const auto weight = static_cast<float>(weights[target]);
    for (std::size_t i = 0; i < vectors.size(); ++i)
      vectors[i] += weight * glm::vec3(moves.values[3 * i], moves.values[3 * i + 1], moves.values[3 * i + 2]);
  }
}

}  // namespace tandem::pathtracer
