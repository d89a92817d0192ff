#pragma once

#include <filesystem>

#include "pathtracer/load/access/load_options.hpp"
#include "pathtracer/scene/scene.hpp"

namespace tandem::pathtracer {

/// Reads a Wavefront OBJ file, the MTL files that it names and their textures (docs/guide/scenes.md says what is
/// understood and how). Throws Error, naming file and line, for what cannot be meant: a missing or truncated file, a
/// missing MTL file or texture or one that may_read refuses, a coordinate that is not a finite number, an index out of
/// range, no triangles, a dielectric without index of refraction. What is merely ignored becomes a warning of the
/// scene.
/// @param origin point of the file that is to be 0,0,0 of the scene
Scene load_obj(const std::filesystem::path& path, const LoadOptions& options = {},
               const glm::dvec3& origin = glm::dvec3(0));

}  // namespace tandem::pathtracer
