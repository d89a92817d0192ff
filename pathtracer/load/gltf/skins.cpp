#include "pathtracer/load/gltf/skins.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "pathtracer/load/gltf/accessor.hpp"

namespace tandem::pathtracer {

std::vector<glm::dmat4> gltf_joint_matrices(GltfDocument& document, const std::vector<GltfNode>& nodes, int index,
                                            std::string_view owner) {
  const tinygltf::Skin& skin = gltf_at(document, document.model.skins, index, "skin", owner);
  const std::string name = gltf_name("skin", static_cast<std::size_t>(index), skin.name);
  std::vector<float> inverse_bind;
  if (skin.inverseBindMatrices >= 0) {
    GltfValues values = gltf_vectors(document, skin.inverseBindMatrices, 16, 16, name);
    if (values.count < skin.joints.size())
      throw gltf_error(document, name,
                       fmt::format("has {} inverse bind matrices for {} joints", values.count, skin.joints.size()));
    inverse_bind = std::move(values.values);
  }
  std::vector<glm::dmat4> matrices;
  for (std::size_t i = 0; i < skin.joints.size(); ++i) {
    gltf_at(document, document.model.nodes, skin.joints[i], "node", name);
    const auto joint = std::ranges::find(nodes, static_cast<std::size_t>(skin.joints[i]), &GltfNode::index);
    if (joint == nodes.end()) {
      gltf_warn(document,
                fmt::format("{} has no effect, because its joint, node {}, is not in the scene", name, skin.joints[i]));
      return {};
    }
    glm::dmat4 bind(1);
    if (!inverse_bind.empty())
      for (int k = 0; k < 16; ++k) bind[k / 4][k % 4] = double{inverse_bind[16 * i + static_cast<std::size_t>(k)]};
    matrices.push_back(joint->transform * bind);
  }
  return matrices;
}

std::vector<glm::dmat4> gltf_vertex_transforms(const GltfDocument& document, const GltfPrimitive& primitive,
                                               const std::vector<glm::dmat4>& joints) {
  std::vector<glm::dmat4> transforms;
  const std::size_t influences = primitive.joints.size() / primitive.positions.size();
  for (std::size_t vertex = 0; vertex < primitive.positions.size(); ++vertex) {
    glm::dmat4 sum(0);
    double total = 0;
    for (std::size_t i = vertex * influences; i < (vertex + 1) * influences; ++i) {
      const double weight = double{primitive.weights[i]};
      if (!(weight > 0)) continue;
      if (primitive.joints[i] >= joints.size())
        throw gltf_error(
            document, primitive.name,
            fmt::format("vertex {} names joint {}, but its skin has {}", vertex, primitive.joints[i], joints.size()));
      sum += weight * joints[primitive.joints[i]];
      total += weight;
    }
    // Weights should add up to 1; those of exporters do so by and large. A vertex without any follows the first joint,
    // as in other viewers.
    if (total > 0)
      sum /= total;
    else
      sum = joints.front();
    transforms.push_back(sum);
  }
  return transforms;
}

}  // namespace tandem::pathtracer
