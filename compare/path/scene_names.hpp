#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "compare/path/event_fields.hpp"
#include "pathtracer/render/path_event.hpp"
#include "pathtracer/scene/scene.hpp"

namespace tandem::compare {

/// What the numbers in events name in a scene.
class SceneNames {
 public:
  explicit SceneNames(const pathtracer::Scene& scene);

  /// "leaf"; "material 3" where it has no name, or there is none such.
  std::string material(std::uint32_t index) const;
  /// "triangle 17 (leaf)", "sphere 2 (glass)"; triangles as devices number them, and spheres from 0 on. "nothing" for
  /// 2^32 - 1. @param index triangles first, then spheres: TracedRay::answer of a closest hit
  std::string primitive(std::uint32_t index) const;
  /// field_text, with a name where the field says which material or primitive: "3 (leaf)", "triangle 17 (leaf)". Of a
  /// shadow ray's answer "blocked" or "free".
  std::string text(const EventField& field, const pathtracer::PathEvent& event) const;

 private:
  std::vector<std::uint32_t> primitive_materials_;  ///< triangles as on devices, then spheres
  std::size_t triangle_count_ = 0;
  std::vector<std::string> material_names_;
};

}  // namespace tandem::compare
