#include "pathtracer/mtl_loader.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tiny_obj_loader.h>

#include "pathtracer/scene.hpp"
#include "pathtracer/wavefront_text.hpp"

namespace tandem::pathtracer {
namespace {

/// What a material starts from where tinyobjloader's own start would be black, or glass that does not refract.
constexpr const char* defaults = "Kd 0.5 0.5 0.5\nNi 0";
/// Of a dielectric that gives none (exporters write Ni 0): window glass.
constexpr float default_ior = 1.5f;

/// What a material says that tinyobjloader does not need to see.
struct Statements {
  std::string name;                   ///< whole: newer tinyobjloaders end a name at a blank
  std::optional<float> opacity;       ///< d
  std::optional<float> transparency;  ///< Tr
  std::string alpha_map;              ///< map_d
};

/// What is gathered while the statements pass by.
struct Reading {
  WavefrontText* text = nullptr;
  std::vector<Statements> materials;  ///< so far
  std::set<std::string> maps;         ///< texture statements that are ignored
  std::set<std::string> options;      ///< of textures that are read
};

/// "Kd r g b" with the numbers checked; "Kd r" means r three times.
std::string checked_color(const Reading& reading, const Statement& statement) {
  std::string_view rest = statement.rest;
  std::string numbers;
  int count = 0;
  for (std::string_view word = take_word(rest); !word.empty() && word[0] != '#' && count < 3; word = take_word(rest)) {
    double value = 0;
    if (!parse_number(word, value))
      throw reading.text->error(fmt::format("{} takes numbers, not '{}'", statement.keyword, word));
    if (!(value >= 0) || !std::isfinite(static_cast<float>(value)))
      throw reading.text->error(fmt::format("{} of {} is not finite and at least 0", statement.keyword, word));
    numbers += fmt::format(" {}", static_cast<float>(value));
    ++count;
  }
  if (count == 1) numbers += numbers + numbers;
  if (count != 1 && count != 3)
    throw reading.text->error(fmt::format("{} takes one or three numbers, here are {}", statement.keyword, count));
  return fmt::format("{}{}", statement.keyword, numbers);
}

std::string checked_ior(const Reading& reading, const Statement& statement) {
  std::string_view rest = statement.rest;
  const std::string_view word = take_word(rest);
  double value = 0;
  if (!parse_number(word, value) || !(value >= 0) || !std::isfinite(static_cast<float>(value)))
    throw reading.text->error(
        fmt::format("an index of refraction (Ni) of '{}' is no finite number of at least 0", word));
  return fmt::format("Ni {}", static_cast<float>(value));
}

std::string checked_illum(const Reading& reading, const Statement& statement) {
  std::string_view rest = statement.rest;
  const std::string_view word = take_word(rest);
  int value = 0;
  if (!parse_integer(word, value) || value < 0 || value > 10)
    throw reading.text->error(fmt::format("illum of '{}' is none of the models 0 to 10", word));
  return fmt::format("illum {}", word);
}

float checked_fraction(const Reading& reading, const Statement& statement) {
  std::string_view rest = statement.rest;
  std::string_view word = take_word(rest);
  if (word == "-halo") word = take_word(rest);
  double value = 0;
  if (!parse_number(word, value) || !(value >= 0 && value <= 1))
    throw reading.text->error(fmt::format("{} of '{}' is no number from 0 to 1", statement.keyword, word));
  return static_cast<float>(value);
}

/// The file name behind the options, blanks included.
std::string texture_file(Reading& reading, const Statement& statement) {
  std::string_view rest = statement.rest;
  while (rest.starts_with('-')) {
    const std::string_view option = take_word(rest);
    reading.options.emplace(option);
    const bool takes_numbers = option == "-o" || option == "-s" || option == "-t" || option == "-mm";
    if (!takes_numbers) take_word(rest);
    double value = 0;
    for (std::string_view after = rest; takes_numbers && parse_number(take_word(after), value);) rest = after;
    rest.remove_prefix(std::min(rest.find_first_not_of(" \t"), rest.size()));
  }
  if (rest.empty()) throw reading.text->error(fmt::format("{} names no file", statement.keyword));
  return std::string(rest);
}

/// Whether the statement is about opacity, and has been read.
bool read_opacity(Reading& reading, const Statement& statement) {
  const bool is_opacity = statement.keyword == "d" || statement.keyword == "Tr" || statement.keyword == "map_d";
  if (!is_opacity) return false;
  if (reading.materials.empty())
    throw reading.text->error(fmt::format("{} stands before the first newmtl", statement.keyword));
  Statements& material = reading.materials.back();
  if (statement.keyword == "d") material.opacity = checked_fraction(reading, statement);
  if (statement.keyword == "Tr") material.transparency = checked_fraction(reading, statement);
  if (statement.keyword == "map_d") material.alpha_map = texture_file(reading, statement);
  return true;
}

std::string filter(Reading& reading, std::string_view text) {
  const Statement statement = split_statement(text);
  if (statement.keyword == "newmtl") {
    if (statement.rest.empty()) throw reading.text->error("newmtl names no material");
    reading.materials.emplace_back().name = statement.rest;
    return fmt::format("newmtl material{}\n{}", reading.materials.size(), defaults);
  }
  if (read_opacity(reading, statement)) return {};
  const bool is_map = statement.keyword.starts_with("map_") || statement.keyword == "bump" ||
                      statement.keyword == "disp" || statement.keyword == "decal" || statement.keyword == "refl" ||
                      statement.keyword == "norm";
  if (is_map) reading.maps.emplace(statement.keyword);
  const bool is_color =
      statement.keyword == "Kd" || statement.keyword == "Ks" || statement.keyword == "Ke" || statement.keyword == "Tf";
  if (!is_color && statement.keyword != "Ni" && statement.keyword != "illum") return {};
  if (reading.materials.empty())
    throw reading.text->error(fmt::format("{} stands before the first newmtl", statement.keyword));
  if (statement.keyword == "Ni") return checked_ior(reading, statement);
  if (statement.keyword == "illum") return checked_illum(reading, statement);
  return checked_color(reading, statement);
}

MaterialModel model_of(int illum) {
  switch (illum) {
    case 3:
    case 5:
    case 8:
      return MaterialModel::mirror;
    case 4:
    case 6:
    case 7:
    case 9:
      return MaterialModel::dielectric;
    default:
      return MaterialModel::diffuse;
  }
}

glm::vec3 vector(const tinyobj::real_t (&values)[3]) { return {values[0], values[1], values[2]}; }

bool exceeds_one(glm::vec3 color) { return std::max({color.x, color.y, color.z}) > 1; }

GpuMaterial material_of(const tinyobj::material_t& source, const Statements& statements, bool& default_ior_used) {
  GpuMaterial material = diffuse_material(vector(source.diffuse), vector(source.emission));
  material.model = model_of(source.illum);
  // Exporters give glass a d below 1 to say that it is glass, which its model says already.
  if (material.model != MaterialModel::dielectric)
    material.opacity = statements.opacity.value_or(1 - statements.transparency.value_or(0));
  material.reflectance = vector(source.specular);
  // tinyobjloader has no mark for a Tf that is absent, and a filter that lets nothing pass is no glass.
  if (vector(source.transmittance) != glm::vec3(0)) material.transmittance = vector(source.transmittance);
  default_ior_used = material.model == MaterialModel::dielectric && source.ior == 0;
  if (material.model == MaterialModel::dielectric) material.ior = default_ior_used ? default_ior : source.ior;
  return material;
}

/// "a, b, c and 5 more"
std::string abbreviated(const std::set<std::string>& names) {
  constexpr std::size_t shown = 4;
  if (names.size() <= shown) return fmt::format("{}", fmt::join(names, ", "));
  return fmt::format("{} and {} more", fmt::join(names.begin(), std::next(names.begin(), shown), ", "),
                     names.size() - shown);
}

}  // namespace

std::vector<NamedMaterial> load_mtl(const std::filesystem::path& path, std::vector<std::string>& warnings) {
  Reading reading;
  WavefrontText text(path, [&](std::string_view statement) { return filter(reading, statement); });
  reading.text = &text;
  std::map<std::string, int> names;
  std::vector<tinyobj::material_t> sources;
  std::string warning, error;
  tinyobj::LoadMtl(&names, &sources, &text.stream(), &warning, &error);
  if (reading.materials.empty()) return {};  // tinyobjloader then gives one that has no name

  std::vector<NamedMaterial> materials;
  std::set<std::string> bright, without_ior, invisible, repeated;
  for (std::size_t index = 0; index < sources.size(); ++index) {
    const tinyobj::material_t& source = sources[index];
    const Statements& statements = reading.materials[index];
    const std::string& name = statements.name;
    const auto same_name = [&](const NamedMaterial& other) { return other.name == name; };
    if (std::any_of(materials.begin(), materials.end(), same_name)) {
      repeated.insert(name);
      continue;
    }
    bool default_ior_used = false;
    const GpuMaterial material = material_of(source, statements, default_ior_used);
    if (default_ior_used) without_ior.insert(name);
    const bool gains = material.model == MaterialModel::diffuse  ? exceeds_one(material.base_color)
                       : material.model == MaterialModel::mirror ? exceeds_one(material.reflectance)
                                                                 : exceeds_one(material.transmittance);
    if (gains) bright.insert(name);
    if (material.opacity == 0) invisible.insert(name);
    materials.push_back({.name = name, .material = material, .alpha_map = {}});
    if (!statements.alpha_map.empty()) materials.back().alpha_map = path.parent_path() / statements.alpha_map;
  }
  const auto warn = [&](const std::set<std::string>& what, const char* sentence) {
    if (!what.empty()) warnings.push_back(fmt::format(fmt::runtime(sentence), path.string(), abbreviated(what)));
  };
  warn(reading.maps, "{}: of textures only map_d is read, so {} has no effect");
  warn(reading.options, "{}: options of textures are ignored: {}");
  warn(bright, "{}: more light leaves than arrives (a factor above 1) at material {}");
  warn(without_ior, "{}: no index of refraction (Ni) is given, so 1.5 is used for material {}");
  warn(invisible, "{}: an opacity (d) of 0 makes invisible the material {}");
  warn(repeated, "{}: only the first definition counts of material {}");
  return materials;
}

}  // namespace tandem::pathtracer
