#include "compare/path/event_fields.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>

namespace tandem::compare {
namespace {

using pathtracer::EventKind;
using pathtracer::PathEvent;

// How far rounding may move what a few operations compute from equal inputs: some 80 units in the last place.
constexpr double geometric = 1e-5;
// Densities and weights contain powers and quotients of small numbers, which multiply the error of a direction.
constexpr double radiometric = 1e-3;
// What a device reports of a hit (docs/internals/rhi-contract.md), of t relative, of barycentrics absolute.
constexpr double reported = 1e-3;

constexpr EventField exact(const char* name, std::size_t word, FieldType type) {
  return {name, word, type, FieldTier::exact, 0.0};
}

constexpr EventField carried(const char* name, std::size_t word, FieldType type, double tolerance) {
  return {name, word, type, FieldTier::carried, tolerance};
}

constexpr EventField observed(const char* name, std::size_t word, FieldType type) {
  return {name, word, type, FieldTier::observed, reported};
}

constexpr std::array camera = {exact("pixel x", 2, FieldType::count),
                               exact("pixel y", 3, FieldType::count),
                               exact("sample", 7, FieldType::count),
                               carried("time", 11, FieldType::number, geometric),
                               carried("origin", 4, FieldType::vector3, geometric),
                               carried("direction", 8, FieldType::vector3, geometric)};

constexpr std::array segment = {exact("depth", 2, FieldType::count),
                                exact("crossings", 3, FieldType::count),
                                exact("medium", 15, FieldType::index),
                                exact("diffuse count", 23, FieldType::count),
                                exact("glossy count", 24, FieldType::count),
                                exact("specular count", 25, FieldType::count),
                                carried("origin", 4, FieldType::vector3, geometric),
                                carried("direction", 8, FieldType::vector3, geometric),
                                carried("throughput", 12, FieldType::color, radiometric),
                                carried("radiance", 16, FieldType::color, radiometric),
                                carried("eta_scale", 11, FieldType::number, radiometric),
                                carried("ray length", 19, FieldType::number, geometric),
                                carried("previous position", 20, FieldType::vector3, geometric),
                                carried("previous density", 7, FieldType::number, radiometric)};

constexpr std::array ray = {exact("ray kind", 2, FieldType::choice),
                            exact("dimension", 3, FieldType::count),
                            carried("origin", 4, FieldType::vector3, geometric),
                            carried("direction", 8, FieldType::vector3, geometric),
                            carried("t max", 7, FieldType::number, geometric),
                            exact("answer", 11, FieldType::index),
                            exact("hit kind", 12, FieldType::choice),
                            exact("instance", 13, FieldType::count),
                            exact("geometry", 14, FieldType::count),
                            exact("primitive", 15, FieldType::count),
                            observed("t", 28, FieldType::number),
                            observed("barycentrics", 29, FieldType::pair)};

constexpr std::array surface = {exact("material", 2, FieldType::index),
                                exact("outside", 3, FieldType::flag),
                                carried("position", 4, FieldType::vector3, geometric),
                                carried("geometric normal", 8, FieldType::vector3, geometric),
                                carried("shading normal", 12, FieldType::vector3, geometric),
                                carried("offset", 7, FieldType::number, radiometric),
                                carried("texture coordinates", 16, FieldType::pair, geometric)};

constexpr std::array medium = {exact("random bits", 2, FieldType::bits), exact("random bits 2", 3, FieldType::bits),
                               exact("scattered", 8, FieldType::flag),
                               carried("distance", 7, FieldType::number, radiometric),
                               carried("weight", 4, FieldType::color, radiometric)};

constexpr std::array emission = {exact("environment", 2, FieldType::flag),
                                 carried("radiance", 4, FieldType::color, radiometric),
                                 carried("contribution", 8, FieldType::color, radiometric)};

constexpr std::array light_sample = {exact("random bits", 4, FieldType::bits),
                                     exact("random bits 2", 5, FieldType::bits),
                                     exact("random bits 3", 6, FieldType::bits),
                                     exact("random bits 4", 7, FieldType::bits),
                                     exact("light", 2, FieldType::index),
                                     exact("infinite", 3, FieldType::flag),
                                     carried("target", 16, FieldType::vector3, geometric),
                                     carried("direction", 8, FieldType::vector3, geometric),
                                     carried("density", 11, FieldType::number, radiometric),
                                     carried("radiance", 12, FieldType::color, radiometric)};

constexpr std::array light_value = {carried("bsdf", 4, FieldType::color, radiometric),
                                    carried("bsdf density", 7, FieldType::number, radiometric),
                                    carried("weight", 11, FieldType::number, radiometric)};

constexpr std::array visibility = {carried("visibility", 4, FieldType::color, radiometric)};

constexpr std::array direct_light = {carried("contribution", 4, FieldType::color, radiometric)};

constexpr std::array scatter = {exact("random bits", 4, FieldType::bits),
                                exact("random bits 2", 5, FieldType::bits),
                                exact("random bits 3", 6, FieldType::bits),
                                exact("random bits 4", 7, FieldType::bits),
                                exact("model", 16, FieldType::choice),
                                exact("lobe", 2, FieldType::choice),
                                exact("leaves", 3, FieldType::flag),
                                carried("direction", 8, FieldType::vector3, geometric),
                                carried("density", 11, FieldType::number, radiometric),
                                carried("weight", 12, FieldType::color, radiometric),
                                carried("eta", 15, FieldType::number, geometric)};

constexpr std::array roulette = {exact("random bits", 3, FieldType::bits),
                                 carried("survival", 4, FieldType::number, radiometric),
                                 exact("survives", 2, FieldType::flag)};

constexpr std::array end = {exact("reason", 2, FieldType::choice), exact("rays", 3, FieldType::count),
                            carried("radiance", 4, FieldType::color, radiometric)};

bool is_real(FieldType type) {
  return type == FieldType::number || type == FieldType::vector3 || type == FieldType::color || type == FieldType::pair;
}

/// Floats in the order of their values as whole numbers: neighbours differ by 1, -0 and +0 are equal.
std::int64_t ordered(std::uint32_t bits) {
  const auto magnitude = static_cast<std::int64_t>(bits & 0x7fffffffu);
  return (bits & 0x80000000u) != 0 ? -magnitude : magnitude;
}

std::string choice_text(const char* field, std::uint32_t value) {
  const std::string_view name = field;
  const auto pick = [value](std::initializer_list<const char*> names) {
    return value < names.size() ? std::string(*(names.begin() + value)) : fmt::format("{}", value);
  };
  if (name == "ray kind") return pick({"closest", "occlusion"});
  if (name == "hit kind") return pick({"none", "front", "back", "procedural"});
  if (name == "reason")
    return pick({"escaped", "depth", "absorbed", "roulette", "side", "crossings", "occluded", "limit"});
  if (name == "lobe") {
    if (value == 0) return "none";
    std::string text;
    const std::pair<std::uint32_t, const char*> lobes[] = {{1, "diffuse"}, {8, "glossy"}, {2, "specular"}};
    for (const auto& [bit, lobe] : lobes)
      if ((value & bit) != 0) text += fmt::format("{}{}", text.empty() ? "" : "+", lobe);
    if ((value & 4u) != 0) text += fmt::format("{}transmission", text.empty() ? "" : " ");
    return text;
  }
  // MATERIAL_* of shaders/scene.glsl; a vertex within a medium has no material.
  if (value == 0xffffffffu) return "medium";
  return pick({"diffuse", "mirror", "dielectric", "oren-nayar", "phong", "blinn-phong", "conductor", "rough dielectric",
               "thin", "principled", "boundary"});
}

}  // namespace

std::span<const EventField> fields_of(EventKind kind) {
  switch (kind) {
    case EventKind::camera:
      return camera;
    case EventKind::segment:
      return segment;
    case EventKind::ray:
      return ray;
    case EventKind::surface:
      return surface;
    case EventKind::medium:
      return medium;
    case EventKind::emission:
      return emission;
    case EventKind::light_sample:
      return light_sample;
    case EventKind::light_value:
      return light_value;
    case EventKind::visibility:
      return visibility;
    case EventKind::direct_light:
      return direct_light;
    case EventKind::scatter:
      return scatter;
    case EventKind::roulette:
      return roulette;
    case EventKind::end:
      return end;
  }
  return {};
}

const char* name(EventKind kind) {
  static constexpr std::array<const char*, pathtracer::event_kind_count + 1> names = {
      "nothing",      "camera",      "segment",    "ray",          "surface", "medium",   "emission",
      "light sample", "light value", "visibility", "direct light", "scatter", "roulette", "end"};
  const auto index = static_cast<std::size_t>(kind);
  return names[index < names.size() ? index : 0];
}

std::size_t word_count(FieldType type) {
  switch (type) {
    case FieldType::vector3:
    case FieldType::color:
      return 3;
    case FieldType::pair:
      return 2;
    default:
      return 1;
  }
}

std::string field_text(const EventField& field, const PathEvent& event) {
  const std::uint32_t word = event.words[field.word];
  switch (field.type) {
    case FieldType::index:
      return word == 0xffffffffu ? std::string("none") : fmt::format("{}", word);
    case FieldType::count:
      return fmt::format("{}", word);
    case FieldType::bits:
      return fmt::format("{:08x}", word);
    case FieldType::flag:
      return word != 0 ? "yes" : "no";
    case FieldType::choice:
      return choice_text(field.name, word);
    default:
      break;
  }
  std::string text;
  for (std::size_t i = 0; i < word_count(field.type); ++i)
    text += fmt::format("{}{:.9g}", i == 0 ? "" : ", ", event.number(field.word + i));
  return text;
}

bool is_equal(const EventField& field, const PathEvent& a, const PathEvent& b) {
  const auto from = static_cast<std::ptrdiff_t>(field.word);
  const auto to = from + static_cast<std::ptrdiff_t>(word_count(field.type));
  return std::equal(a.words.begin() + from, a.words.begin() + to, b.words.begin() + from);
}

std::uint32_t ulp_distance(const EventField& field, const PathEvent& a, const PathEvent& b) {
  constexpr std::uint32_t farthest = std::numeric_limits<std::uint32_t>::max();
  if (is_equal(field, a, b)) return 0;
  if (!is_real(field.type)) return farthest;
  std::int64_t largest = 0;
  for (std::size_t i = field.word; i < field.word + word_count(field.type); ++i) {
    if (a.words[i] == b.words[i]) continue;
    if (std::isnan(a.number(i)) || std::isnan(b.number(i))) return farthest;
    largest = std::max(largest, std::abs(ordered(a.words[i]) - ordered(b.words[i])));
  }
  return static_cast<std::uint32_t>(std::min<std::int64_t>(largest, farthest));
}

double relative_difference(const EventField& field, const PathEvent& a, const PathEvent& b) {
  if (is_equal(field, a, b)) return 0.0;
  if (!is_real(field.type)) return std::numeric_limits<double>::infinity();
  // Two coordinates of a parameterisation: the unit square is what they are measured by.
  double magnitude = field.type == FieldType::pair ? 1.0 : 0.0;
  double difference = 0.0;
  for (std::size_t i = field.word; i < field.word + word_count(field.type); ++i) {
    if (a.words[i] == b.words[i]) continue;
    const double x = a.number(i), y = b.number(i);
    if (!std::isfinite(x) || !std::isfinite(y)) return std::numeric_limits<double>::infinity();
    difference = std::max(difference, std::abs(x - y));
  }
  for (std::size_t i = field.word; i < field.word + word_count(field.type); ++i)
    magnitude = std::max({magnitude, std::abs(double{a.number(i)}), std::abs(double{b.number(i)})});
  return magnitude > 0.0 ? difference / magnitude : 0.0;
}

}  // namespace tandem::compare
