#include "compare/path/scene_names.hpp"

#include <fmt/format.h>

#include <string_view>

namespace tandem::compare {
namespace {

constexpr std::uint32_t none = 0xffffffffu;

std::uint32_t material_of(const pathtracer::GpuTriangle& triangle) {
  return triangle.material & ~pathtracer::triangle_smooth;
}

}  // namespace

SceneNames::SceneNames(const pathtracer::Scene& scene)
    : triangle_count_(scene.triangles.size()), material_names_(scene.material_names) {
  primitive_materials_.reserve(scene.triangles.size() + scene.spheres.size());
  // pathtracer::in_device_order, without a copy of the scene.
  for (const bool transparent : {false, true}) {
    for (const pathtracer::GpuTriangle& triangle : scene.triangles)
      if (is_transparent(scene, triangle) == transparent) primitive_materials_.push_back(material_of(triangle));
  }
  for (const pathtracer::GpuSphere& sphere : scene.spheres) primitive_materials_.push_back(sphere.material);
}

std::string SceneNames::material(std::uint32_t index) const {
  if (index < material_names_.size() && !material_names_[index].empty()) return material_names_[index];
  return fmt::format("material {}", index);
}

std::string SceneNames::primitive(std::uint32_t index) const {
  if (index == none) return "nothing";
  if (index >= primitive_materials_.size()) return fmt::format("primitive {}, which the scene does not have", index);
  const bool sphere = index >= triangle_count_;
  return fmt::format("{} {} ({})", sphere ? "sphere" : "triangle", sphere ? index - triangle_count_ : index,
                     material(primitive_materials_[index]));
}

std::string SceneNames::text(const EventField& field, const pathtracer::PathEvent& event) const {
  const std::uint32_t word = event.words[field.word];
  const std::string_view name = field.name;
  if (event.kind() == pathtracer::EventKind::ray && name == "answer") {
    const bool closest = event.words[pathtracer::event_word::ray_kind] == 0;
    return closest ? primitive(word) : word != 0 ? "blocked" : "free";
  }
  if (event.kind() == pathtracer::EventKind::light_sample && name == "light" && word != none) return primitive(word);
  if (event.kind() == pathtracer::EventKind::surface && name == "material" && word != none)
    return fmt::format("{} ({})", word, material(word));
  return field_text(field, event);
}

}  // namespace tandem::compare
