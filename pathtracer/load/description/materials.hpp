#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "base/json_value.hpp"
#include "pathtracer/load/description/ranges.hpp"
#include "pathtracer/load/description/textures.hpp"
#include "pathtracer/scene/scene.hpp"

namespace tandem::pathtracer::description {

/// Indices into lists of a scene by the names that a description gives.
class NamedIndices {
 public:
  explicit NamedIndices(std::string kind) : kind_(std::move(kind)) {}

  void add(const std::string& name, std::uint32_t index) { indices_.emplace(name, index); }
  /// Of the entry that the value names. Throws Error.
  std::uint32_t find(const Value& name) const;

 private:
  std::string kind_;  ///< "materials"
  std::map<std::string, std::uint32_t> indices_;
};

/// Adds the media of a description to the scene. Throws Error.
NamedIndices read_media(const std::optional<Value>& definitions, Scene& scene);

/// Adds the materials of a description to the scene. Throws Error.
NamedIndices read_materials(const std::optional<Value>& definitions, Textures& textures, const NamedIndices& media,
                            Scene& scene);

}  // namespace tandem::pathtracer::description
