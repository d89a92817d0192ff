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
namespace word = pathtracer::event_word;

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

constexpr std::array camera = {exact("pixel x", word::camera_pixel_x, FieldType::count),
                               exact("pixel y", word::camera_pixel_y, FieldType::count),
                               exact("sample", word::camera_sample, FieldType::count),
                               carried("time", word::camera_time, FieldType::number, geometric),
                               carried("origin", word::camera_origin, FieldType::vector3, geometric),
                               carried("direction", word::camera_direction, FieldType::vector3, geometric)};

constexpr std::array segment = {
    exact("depth", word::segment_depth, FieldType::count),
    exact("crossings", word::segment_crossings, FieldType::count),
    exact("medium", word::segment_medium, FieldType::index),
    exact("diffuse count", word::segment_diffuse_count, FieldType::count),
    exact("glossy count", word::segment_glossy_count, FieldType::count),
    exact("specular count", word::segment_specular_count, FieldType::count),
    carried("origin", word::segment_origin, FieldType::vector3, geometric),
    carried("direction", word::segment_direction, FieldType::vector3, geometric),
    carried("throughput", word::segment_throughput, FieldType::color, radiometric),
    carried("radiance", word::segment_radiance, FieldType::color, radiometric),
    carried("eta_scale", word::segment_eta_scale, FieldType::number, radiometric),
    carried("ray length", word::segment_ray_length, FieldType::number, geometric),
    carried("previous position", word::segment_previous_position, FieldType::vector3, geometric),
    carried("previous density", word::segment_previous_density, FieldType::number, radiometric)};

constexpr std::array ray = {exact("ray kind", word::ray_kind, FieldType::choice),
                            exact("dimension", word::ray_dimension, FieldType::count),
                            carried("origin", word::ray_origin, FieldType::vector3, geometric),
                            carried("direction", word::ray_direction, FieldType::vector3, geometric),
                            carried("t max", word::ray_t_max, FieldType::number, geometric),
                            exact("answer", word::ray_answer, FieldType::index),
                            exact("hit kind", word::hit_kind, FieldType::choice),
                            exact("instance", word::hit_instance, FieldType::count),
                            exact("geometry", word::hit_geometry, FieldType::count),
                            exact("primitive", word::hit_primitive, FieldType::count),
                            observed("t", word::hit_t, FieldType::number),
                            observed("barycentrics", word::hit_barycentrics, FieldType::pair)};

constexpr std::array surface = {
    exact("material", word::surface_material, FieldType::index),
    exact("outside", word::surface_outside, FieldType::flag),
    carried("position", word::surface_position, FieldType::vector3, geometric),
    carried("geometric normal", word::surface_geometric_normal, FieldType::vector3, geometric),
    carried("shading normal", word::surface_shading_normal, FieldType::vector3, geometric),
    carried("offset", word::surface_offset, FieldType::number, radiometric),
    carried("texture coordinates", word::surface_texture_coordinates, FieldType::pair, geometric)};

constexpr std::array medium = {exact("random bits", word::medium_bits, FieldType::bits),
                               exact("random bits 2", word::medium_bits + 1, FieldType::bits),
                               exact("scattered", word::medium_scattered, FieldType::flag),
                               carried("distance", word::medium_distance, FieldType::number, radiometric),
                               carried("weight", word::medium_weight, FieldType::color, radiometric)};

constexpr std::array emission = {exact("environment", word::emission_environment, FieldType::flag),
                                 carried("radiance", word::emission_radiance, FieldType::color, radiometric),
                                 carried("contribution", word::emission_contribution, FieldType::color, radiometric)};

constexpr std::array light_sample = {exact("random bits", word::light_sample_bits, FieldType::bits),
                                     exact("random bits 2", word::light_sample_bits + 1, FieldType::bits),
                                     exact("random bits 3", word::light_sample_bits + 2, FieldType::bits),
                                     exact("random bits 4", word::light_sample_bits + 3, FieldType::bits),
                                     exact("light", word::light_sample_light, FieldType::index),
                                     exact("infinite", word::light_sample_infinite, FieldType::flag),
                                     carried("target", word::light_sample_target, FieldType::vector3, geometric),
                                     carried("direction", word::light_sample_direction, FieldType::vector3, geometric),
                                     carried("density", word::light_sample_density, FieldType::number, radiometric),
                                     carried("radiance", word::light_sample_radiance, FieldType::color, radiometric)};

constexpr std::array light_value = {
    carried("bsdf", word::light_value_bsdf, FieldType::color, radiometric),
    carried("bsdf density", word::light_value_bsdf_density, FieldType::number, radiometric),
    carried("weight", word::light_value_weight, FieldType::number, radiometric)};

constexpr std::array visibility = {carried("visibility", word::visibility, FieldType::color, radiometric)};

constexpr std::array direct_light = {
    carried("contribution", word::direct_light_contribution, FieldType::color, radiometric)};

constexpr std::array scatter = {exact("random bits", word::scatter_bits, FieldType::bits),
                                exact("random bits 2", word::scatter_bits + 1, FieldType::bits),
                                exact("random bits 3", word::scatter_bits + 2, FieldType::bits),
                                exact("random bits 4", word::scatter_bits + 3, FieldType::bits),
                                exact("model", word::scatter_model, FieldType::choice),
                                exact("lobe", word::scatter_lobe, FieldType::choice),
                                exact("leaves", word::scatter_leaves, FieldType::flag),
                                carried("direction", word::scatter_direction, FieldType::vector3, geometric),
                                carried("density", word::scatter_density, FieldType::number, radiometric),
                                carried("weight", word::scatter_weight, FieldType::color, radiometric),
                                carried("eta", word::scatter_eta, FieldType::number, geometric)};

constexpr std::array roulette = {exact("random bits", word::roulette_bits, FieldType::bits),
                                 carried("survival", word::roulette_survival, FieldType::number, radiometric),
                                 exact("survives", word::roulette_survives, FieldType::flag)};

constexpr std::array end = {exact("reason", word::end_reason, FieldType::choice),
                            exact("rays", word::end_ray_count, FieldType::count),
                            carried("radiance", word::end_radiance, FieldType::color, radiometric)};

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

float unit_interval(std::uint32_t bits) { return static_cast<float>(bits >> 8u) * 0x1p-24f; }

std::string field_text(const EventField& field, const PathEvent& event) {
  const std::uint32_t value = event.words[field.word];
  switch (field.type) {
    case FieldType::index:
      return value == 0xffffffffu ? std::string("none") : fmt::format("{}", value);
    case FieldType::count:
      return fmt::format("{}", value);
    case FieldType::bits:
      return fmt::format("{:08x}", value);
    case FieldType::flag:
      return value != 0 ? "yes" : "no";
    case FieldType::choice:
      return choice_text(field.name, value);
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
