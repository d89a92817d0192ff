#include "pathtracer/load/obj/mtl_loader.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string_view>

#include <fmt/format.h>

#include "base/printable.hpp"
#include "pathtracer/load/obj/mtl_material.hpp"
#include "pathtracer/load/obj/wavefront_text.hpp"
#include "pathtracer/scene/scene.hpp"

namespace tandem::pathtracer {
namespace {

/// What is gathered while the statements pass by.
struct Reading {
  const WavefrontText* text = nullptr;
  std::vector<MtlStatements> materials;  ///< so far
  std::set<std::string> maps;            ///< texture statements that are ignored
  std::set<std::string> options;         ///< of textures that are read
};

/// "Kd r g b"; "Kd r" means r three times.
glm::vec3 checked_color(const Reading& reading, const Statement& statement) {
  std::string_view rest = statement.rest;
  std::array<float, 3> numbers{};
  std::size_t count = 0;
  for (std::string_view word = take_word(rest); !word.empty() && word[0] != '#' && count < 3; word = take_word(rest)) {
    double value = 0;
    if (!parse_number(word, value))
      throw reading.text->error(fmt::format("{} takes numbers, not '{}'", statement.keyword, shortened(word)));
    if (!(value >= 0) || !std::isfinite(static_cast<float>(value)))
      throw reading.text->error(
          fmt::format("{} of {} is not finite and at least 0", statement.keyword, shortened(word)));
    numbers[count++] = static_cast<float>(value);
  }
  if (count == 1) return glm::vec3(numbers[0]);
  if (count != 3)
    throw reading.text->error(fmt::format("{} takes one or three numbers, not {}", statement.keyword, count));
  return {numbers[0], numbers[1], numbers[2]};
}

float checked_number(const Reading& reading, const Statement& statement, double largest, std::string_view what) {
  std::string_view rest = statement.rest;
  std::string_view word = take_word(rest);
  if (word == "-halo") word = take_word(rest);
  double value = 0;
  if (!parse_number(word, value) || !(value >= 0 && value <= largest) || !std::isfinite(static_cast<float>(value)))
    throw reading.text->error(fmt::format("{} of '{}' is no {}", statement.keyword, shortened(word), what));
  return static_cast<float>(value);
}

int checked_illum(const Reading& reading, const Statement& statement) {
  std::string_view rest = statement.rest;
  const std::string_view word = take_word(rest);
  int value = 0;
  if (!parse_integer(word, value) || value < 0 || value > 10)
    throw reading.text->error(fmt::format("illum of '{}' is not one of the models 0 to 10", shortened(word)));
  return value;
}

/// What a statement that names a texture is about, or "" for one that is no such statement.
std::string_view mapped(std::string_view keyword) {
  if (keyword == "bump" || keyword == "map_bump" || keyword == "map_Bump") return "bump";
  if (keyword.starts_with("map_")) return keyword.substr(4);
  for (const std::string_view other : {"norm", "disp", "decal", "refl"})
    if (keyword == other) return keyword;
  return {};
}

bool is_one_of(std::string_view word, std::initializer_list<std::string_view> words) {
  return std::ranges::find(words, word) != words.end();
}

void read(Reading& reading, std::string_view line) {
  const Statement statement = split_statement(line);
  const std::string_view keyword = statement.keyword;
  if (keyword == "newmtl") {
    if (statement.rest.empty()) throw reading.text->error("newmtl names no material");
    reading.materials.emplace_back().name = statement.rest;
    return;
  }
  const std::string_view map = mapped(keyword);
  const bool is_read_map = is_one_of(map, {"Kd", "Ks", "Ke", "Tf", "Ns", "Pr", "Pm", "d", "bump", "norm"});
  if (!map.empty() && !is_read_map) reading.maps.emplace(keyword);
  const bool is_color = is_one_of(keyword, {"Kd", "Ks", "Ke", "Tf"});
  const bool is_fraction = is_one_of(keyword, {"d", "Tr", "Pr", "Pm"});
  const bool is_number = is_one_of(keyword, {"Ni", "Ns"});
  if (!is_read_map && !is_color && !is_fraction && !is_number && keyword != "illum") return;
  if (reading.materials.empty()) throw reading.text->error(fmt::format("{} stands before the first newmtl", keyword));
  MtlStatements& material = reading.materials.back();
  if (is_read_map) {
    material.maps.insert_or_assign(std::string(map), parse_mtl_map(*reading.text, statement, reading.options));
    return;
  }
  const std::string name(keyword);
  material.unusable.erase(name);
  try {
    if (is_color)
      material.colors.insert_or_assign(name, checked_color(reading, statement));
    else if (is_fraction)
      material.numbers.insert_or_assign(name, checked_number(reading, statement, 1, "number from 0 to 1"));
    else if (is_number)
      material.numbers.insert_or_assign(name, checked_number(reading, statement, 1e30, "number from 0 to 1e+30"));
    else
      material.illum = checked_illum(reading, statement);
  } catch (const Error& error) {
    // Exporters write what is no value where nothing needs one.
    material.unusable.insert_or_assign(name, error.what());
  }
}

}  // namespace

std::vector<NamedMaterial> load_mtl(const std::filesystem::path& path, std::vector<std::string>& warnings) {
  Reading reading;
  WavefrontText text(path, [&](std::string_view line) {
    read(reading, line);
    return std::string();
  });
  reading.text = &text;
  text.stream().peek();  // reads all of it: no statement is left for the stream

  std::vector<NamedMaterial> materials;
  MtlRemarks remarks;
  std::set<std::string> names, repeated;
  for (const MtlStatements& statements : reading.materials) {
    if (!names.insert(statements.name).second) {
      repeated.insert(statements.name);
      continue;
    }
    try {
      materials.push_back(material_of(statements, remarks));
    } catch (const Error& error) {
      materials.push_back(
          {.name = statements.name, .material = diffuse_material(glm::vec3(0.5f)), .maps = {}, .error = error.what()});
    }
  }
  const auto warn = [&](const std::set<std::string>& what, const char* sentence) {
    const std::vector<std::string> list(what.begin(), what.end());
    if (!what.empty()) warnings.push_back(fmt::format(fmt::runtime(sentence), path.string(), abbreviated(list)));
  };
  warn(reading.maps, "{}: textures of these kinds are not read: {}");
  warn(reading.options, "{}: options of textures are ignored: {}");
  warn(remarks.bright, "{}: more light leaves than arrives (a factor above 1) at material {}");
  warn(remarks.scaled, "{}: Kd and Ks add up to more than 1, so both are scaled down, of material {}");
  warn(remarks.without_ior, "{}: no index of refraction (Ni) is given, so 1.5 is used for material {}");
  warn(remarks.invisible, "{}: an opacity (d) of 0 makes invisible the material {}");
  warn(remarks.unneeded, "{}: values that cannot be used are ignored, since their materials do not need them: {}");
  warn(repeated, "{}: only the first definition counts of material {}");
  return materials;
}

}  // namespace tandem::pathtracer
