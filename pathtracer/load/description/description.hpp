#pragma once

#include <filesystem>

#include "pathtracer/load/access/load_options.hpp"
#include "pathtracer/load/description/geometry.hpp"
#include "pathtracer/scene/scene.hpp"

namespace tandem::pathtracer {

/// Reads a scene description: a JSON file that docs/guide/scenes.md explains and docs/schema/scene.schema.json
/// specifies. It is read strictly: throws Error, naming the file and the place in it ("scene.json: spheres[2].radius
/// must be a positive number"), for members that are unknown, missing, given twice, of another type or out of range,
/// for names that stand for nothing, for a scene without triangles and spheres, and for what the loaders of its models
/// and images refuse.
/// @param options with a folder (options_within)  @param load_model reads the models that it names
/// @param origin point of the description that is to be 0,0,0 of the scene
Scene load_description(const std::filesystem::path& path, const LoadOptions& options,
                       const description::ModelLoader& load_model, const glm::dvec3& origin = glm::dvec3(0));

}  // namespace tandem::pathtracer
