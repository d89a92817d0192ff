#pragma once

#include <filesystem>
#include <functional>
#include <optional>

#include "base/json_value.hpp"
#include "pathtracer/load/access/load_options.hpp"
#include "pathtracer/load/description/materials.hpp"
#include "pathtracer/load/description/ranges.hpp"
#include "pathtracer/scene/scene.hpp"

namespace tandem::pathtracer::description {

/// A point of the description in the coordinates of the scene. Throws Error.
glm::vec3 read_point(const Value& value, const Scene& scene);

/// Reads a model: any scene file that is not a description itself.
using ModelLoader = std::function<Scene(const std::filesystem::path&)>;

/// Adds the files that "models" lists, relative to `folder`, where `options` allow them. Throws Error, also for what
/// their loaders refuse.
void add_models(const std::optional<Value>& list, const std::filesystem::path& folder, const LoadOptions& options,
                const ModelLoader& load_model, const NamedIndices& materials, Scene& scene);

/// Add what the lists of these names describe. Throw Error.
void add_spheres(const std::optional<Value>& list, const NamedIndices& materials, Scene& scene);
void add_boxes(const std::optional<Value>& list, const NamedIndices& materials, Scene& scene);
void add_quads(const std::optional<Value>& list, const NamedIndices& materials, Scene& scene);

/// Adds the parallelogram with a corner and two sides, whose texture coordinates are (0, 0) at the corner and (1, 1)
/// opposite; seen counter-clockwise from the side to which u x v points. Throws Error, naming the value, when it is
/// degenerate.
void add_parallelogram(const Value& value, glm::vec3 corner, glm::vec3 u, glm::vec3 v, std::uint32_t material,
                       Scene& scene);

}  // namespace tandem::pathtracer::description
