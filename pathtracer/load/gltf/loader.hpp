#pragma once

#include <filesystem>

#include "pathtracer/load/access/load_options.hpp"
#include "pathtracer/scene/scene.hpp"

namespace tandem::pathtracer {

/// Reads the default scene of a glTF 2.0 file (.gltf or .glb) with its buffers and images (docs/guide/scenes.md says
/// what is understood and how). Instances of a mesh become triangles of their own in world space. Throws Error, naming
/// the file and the object in it, for what cannot be meant: a missing or truncated file, buffer or image, an index out
/// of range, an accessor beyond its buffer, a coordinate that is not a finite number, nodes in a circle, an extension
/// that the file requires and Tandem lacks, no triangles. What is merely ignored becomes a warning of the scene, one
/// for each kind.
/// @param origin point of the file that is to be 0,0,0 of the scene
Scene load_gltf(const std::filesystem::path& path, const LoadOptions& options = {},
                const glm::dvec3& origin = glm::dvec3(0));

}  // namespace tandem::pathtracer
