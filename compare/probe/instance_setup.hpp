#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "pathtracer/scene/scene.hpp"
#include "rhi/acceleration_structure.hpp"

namespace tandem::compare {

/// How the scene's geometry is put into acceleration structures.
enum class InstanceSetup {
  plain,            ///< once, where it is
  instances,        ///< four times, side by side: where it is, turned, mirrored, sheared, under masks of their own
  instance_flags,   ///< likewise, but only moved; each with a flag
  refitted,         ///< built with all primitives elsewhere, then updated
  moved,            ///< as plain, its top level built with everything elsewhere and switched off, then updated
  build_transform,  ///< triangles only, moved and mirrored when they are built
  without_indices,  ///< plain, its triangles without an index buffer
  compacted,        ///< plain, its bottom levels compacted
};

/// A row-major 3x4 matrix, as rhi::InstanceDesc has it.
using Transform = std::array<float, 12>;
inline constexpr Transform identity_transform = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};

/// The scene, or a copy of it, somewhere in the world: one instance of its triangles, and after that one of its
/// spheres.
struct Placement {
  Transform transform = identity_transform;  ///< of the instances, or of the geometry as it is built
  std::uint32_t mask = 0xff;
  rhi::InstanceFlags flags = rhi::InstanceFlags::none;
};

/// @param scene with finite positions; its bounds decide how far apart copies are
std::vector<Placement> placements(InstanceSetup instance_setup, const pathtracer::Scene& scene);

/// Whether the triangles of the instance_setup are transformed as they are built, and its instance is not.
inline bool is_transformed_at_build(InstanceSetup instance_setup) {
  return instance_setup == InstanceSetup::build_transform;
}

/// What is told apart in an instance of placement `index`: numbers that are neither each other's nor any index.
std::uint32_t custom_index(std::uint32_t placement, bool spheres);
/// Its offset into the hit records, of which there are four: even ones are for triangles, odd ones for spheres.
std::uint32_t hit_record(std::uint32_t placement, bool spheres);

}  // namespace tandem::compare
