#include "pathtracer/load/obj/obj_materials.hpp"

#include <optional>
#include <utility>

#include <fmt/format.h>

#include "pathtracer/load/access/file_access.hpp"

namespace tandem::pathtracer {
namespace {

constexpr glm::vec3 grey{0.5f};

}  // namespace

ObjMaterials::ObjMaterials(const WavefrontText& text, LoadOptions options, Scene& scene)
    : text_(&text), options_(std::move(options)), scene_(&scene) {}

void ObjMaterials::load_libraries(std::string_view names) {
  if (names.empty()) throw text_->error("mtllib names no file");
  std::error_code status_error;
  if (std::filesystem::exists(text_->path().parent_path() / names, status_error))
    return load_library(std::string(names));
  for (std::string_view name = take_word(names); !name.empty(); name = take_word(names))
    load_library(std::string(name));
}

void ObjMaterials::load_library(const std::string& name) {
  if (!libraries_.insert(name).second) return;
  const std::filesystem::path path = text_->path().parent_path() / name;
  std::error_code status_error;
  const bool is_inside = may_read(path, options_);
  if (!is_inside || !std::filesystem::exists(path, status_error)) {
    const Error error = text_->error(is_inside ? fmt::format("the material file '{}' does not exist", path.string())
                                               : outside_sentence(path));
    if (!options_.allow_missing_mtl) throw error;
    scene_->warnings.emplace_back(error.what());
    return;
  }
  for (NamedMaterial& material : load_mtl(path, scene_->warnings))
    if (entry_names_.emplace(material.name, entries_.size()).second)
      entries_.push_back({std::move(material), path.parent_path(), text_->place()});
}

std::uint32_t ObjMaterials::use(std::string_view name) {
  const auto known = use_numbers_.find(name);
  if (known != use_numbers_.end()) return known->second;
  const auto number = static_cast<std::uint32_t>(uses_.size());
  uses_.emplace_back(name);
  use_numbers_.emplace(name, number);
  return number;
}

std::uint32_t ObjMaterials::add(const std::string& name, const GpuMaterial& material) {
  scene_->materials.push_back(material);
  scene_->material_names.push_back(name);
  return static_cast<std::uint32_t>(scene_->materials.size() - 1);
}

void ObjMaterials::load_textures(Entry& entry) {
  for (const MaterialMap& map : entry.material.maps) {
    if (const auto file = find_texture(entry.folder, map.file, options_)) {
      entry.material.material.*map.member = texture_of(*scene_, textures_, *file, map);
      continue;
    }
    const std::filesystem::path path = entry.folder / map.file;
    const std::string sentence = may_read(path, options_)
                                     ? fmt::format("{}: the texture '{}' does not exist", entry.place, path.string())
                                     : fmt::format("{}: {}", entry.place, outside_sentence(path));
    if (!options_.allow_missing_mtl) throw Error(sentence);
    if (missing_textures_.insert(path).second) scene_->warnings.push_back(sentence);
  }
}

std::vector<std::uint32_t> ObjMaterials::resolve(std::vector<bool> used) {
  used.resize(uses_.size());
  std::set<std::string, std::less<>> needed;
  for (std::size_t number = 1; number < uses_.size(); ++number)
    if (used[number]) needed.insert(uses_[number]);
  // Faces before the first usemtl have the material of a library that defines just one, as some exporters mean it.
  bool all_known = true;
  for (const std::string& name : needed) all_known = all_known && entry_names_.contains(name);
  const bool only_one = entries_.size() == 1 && all_known;
  if (only_one && used[unnamed]) needed.insert(entries_.front().material.name);

  std::map<std::string, std::uint32_t, std::less<>> indices;
  std::vector<std::string> unusable;
  for (Entry& entry : entries_) {
    const bool is_needed = needed.contains(entry.material.name);
    if (is_needed && entry.material.error) throw Error(*entry.material.error);
    if (is_needed) load_textures(entry);
    if (entry.material.error) unusable.push_back(entry.material.name);
    indices.emplace(entry.material.name, add(entry.material.name, entry.material.material));
  }
  std::optional<std::uint32_t> default_material;
  const auto use_default = [&] {
    if (!default_material) default_material = add("default", diffuse_material(grey));
    return *default_material;
  };
  std::vector<std::uint32_t> resolved(uses_.size(), 0);
  std::vector<std::string> unknown;
  for (std::size_t number = 0; number < uses_.size(); ++number) {
    if (!used[number]) continue;
    const auto found = indices.find(uses_[number]);
    if (number == unnamed) {
      resolved[number] = only_one ? 0 : use_default();
    } else if (found != indices.end()) {
      resolved[number] = found->second;
    } else {
      unknown.push_back(uses_[number]);
      resolved[number] = use_default();
    }
  }
  const auto warn = [&](const std::vector<std::string>& names, std::string_view sentence) {
    if (!names.empty())
      scene_->warnings.push_back(fmt::format("{}: {}: {}", text_->path().string(), sentence, abbreviated(names)));
  };
  warn(unknown, "unknown materials are grey");
  warn(unusable, "materials that no face uses are ignored, since they have values that cannot be used");
  return resolved;
}

}  // namespace tandem::pathtracer
