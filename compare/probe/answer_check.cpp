#include "compare/probe/answer_check.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "compare/geometry/rounding.hpp"

namespace tandem::compare {
namespace {

PrimitiveId id_of(const ProbeAnswer& answer) {
  return {.type = answer.type, .instance = answer.instance, .geometry = answer.geometry, .primitive = answer.primitive};
}

/// The hit that an answer describes: of a sphere the side that its t is nearest to. Null for a miss, and for what the
/// reference does not find on the ray.
const ProbeHit* find(std::span<const ProbeHit> hits, const ProbeAnswer& answer) {
  const ProbeHit* found = nullptr;
  const auto distance = [&](const ProbeHit& hit) {
    return std::max({0.0, hit.intersection.t_low - answer.t, answer.t - hit.intersection.t_high});
  };
  for (const ProbeHit& hit : hits)
    if (hit.id == id_of(answer) && (!found || distance(hit) < distance(*found))) found = &hit;
  return found;
}

bool anything_counts(std::span<const ProbeHit> hits) {
  return std::any_of(hits.begin(), hits.end(), [](const ProbeHit& hit) { return hit.counts; });
}

/// Whether t lies where the ray meets the hit's surface.
bool is_at(const Intersection& intersection, double t) { return t >= intersection.t_low && t <= intersection.t_high; }

/// Whether the answer names a primitive that may be the first, and where the ray meets it.
bool is_right_primitive(const Trial& trial, std::span<const ProbeHit> hits, const ProbeAnswer& answer) {
  if (answer.type == AnswerType::miss) return !anything_counts(hits);
  if (trial.any_hit) return answer.type != AnswerType::missing && !hits.empty();
  const ProbeHit* const hit = find(hits, answer);
  return hit && is_at(hit->intersection, answer.t);
}

bool is_within(double value, double expected, double error) { return std::abs(value - expected) <= error; }

/// A matrix as a device reports it, and what it may be off by: as much as inverting it in single precision takes.
bool is_right_element(const AffineMap& map, std::size_t element, double value) {
  const int row = static_cast<int>(element / 4), column = static_cast<int>(element % 4);
  double magnitude = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) magnitude = std::max(magnitude, std::abs(map.linear[j][i]));
  if (column < 3) return is_within(value, map.linear[column][row], rounding_distance(magnitude));
  // The translation of one is that of the other, mapped.
  magnitude = std::max(mapped_magnitude(map, inverse(map).translation), mapped_magnitude(map, glm::dvec3(0)));
  return is_within(value, map.translation[row], rounding_distance(magnitude));
}

/// Whether a field of an answer with the right primitive has a value that it may have.
bool is_right_field(std::span<const ProbeInstance> instances, const ProbeRay& ray, const ProbeHit& hit,
                    const ProbeField& field, const ProbeAnswer& answer) {
  const ProbeInstance& instance = instances[hit.id.instance];
  const Intersection& intersection = hit.intersection;
  const std::uint32_t bits = bits_of(answer, field);
  const double value = std::bit_cast<float>(bits);
  const bool is_triangle = hit.id.type == AnswerType::triangle;
  const auto index_in = [&](std::size_t offset) { return (field.offset - offset) / sizeof(float); };
  switch (field.offset) {
    case offsetof(ProbeAnswer, custom_index):
      return bits == instance.custom_index;
    case offsetof(ProbeAnswer, record):
      return bits == instance.hit_record;
    case offsetof(ProbeAnswer, hit_kind):
      if (!is_triangle) return bits == hit_kind::sphere;
      if (!intersection.front_face) return bits == hit_kind::front || bits == hit_kind::back;
      return bits == (*intersection.front_face ? hit_kind::front : hit_kind::back);
    case offsetof(ProbeAnswer, t):
      return is_at(intersection, value);
    default:
      break;
  }
  if (field.offset >= offsetof(ProbeAnswer, world_to_object))
    return is_right_element(inverse(map_of(instance.transform)), index_in(offsetof(ProbeAnswer, world_to_object)),
                            value);
  if (field.offset >= offsetof(ProbeAnswer, object_to_world))
    return is_right_element(map_of(instance.transform), index_in(offsetof(ProbeAnswer, object_to_world)), value);
  AffineMap to_object = inverse(map_of(instance.transform));
  if (field.offset >= offsetof(ProbeAnswer, object_direction)) {
    to_object.translation = glm::dvec3(0);
    const glm::dvec3 direction(ray.direction);
    const auto axis = static_cast<int>(index_in(offsetof(ProbeAnswer, object_direction)));
    return is_within(value, to_object.point(direction)[axis],
                     rounding_distance(mapped_magnitude(to_object, direction)));
  }
  if (field.offset >= offsetof(ProbeAnswer, object_origin)) {
    const glm::dvec3 origin(ray.origin);
    const auto axis = static_cast<int>(index_in(offsetof(ProbeAnswer, object_origin)));
    return is_within(value, to_object.point(origin)[axis], rounding_distance(mapped_magnitude(to_object, origin)));
  }
  const std::size_t coordinate = index_in(offsetof(ProbeAnswer, barycentrics));
  return is_triangle
             ? is_within(value, intersection.barycentrics[coordinate], intersection.barycentric_errors[coordinate])
             : value == 0;
}

Ruling ruling_of(bool a_right, bool b_right) {
  if (a_right == b_right) return a_right ? Ruling::tie : Ruling::both_wrong;
  return a_right ? Ruling::a_right : Ruling::b_right;
}

/// Of two answers that may both be right.
DifferenceClass class_of_tie(const Trial& trial, const ProbeHit* a, const ProbeHit* b) {
  if (trial.any_hit) return DifferenceClass::grazing_visibility;
  if (a && b && a->intersection.certain && b->intersection.certain) return DifferenceClass::coincident_geometry;
  const ProbeHit* only = a ? a : b;
  // What the ray meets the inside of, but where it begins or ends.
  if (!(a && b) && only && only->intersection.certain) return DifferenceClass::grazing_visibility;
  return DifferenceClass::edge_or_vertex_tie;
}

bool is_hit(const ProbeAnswer& answer) {
  return answer.type == AnswerType::triangle || answer.type == AnswerType::sphere;
}

}  // namespace

bool differ(const Trial& trial, const ProbeAnswer& a, const ProbeAnswer& b) {
  return std::memcmp(&a, &b, sizeof(a)) != 0 && !(trial.any_hit && is_hit(a) && is_hit(b));
}

AnswerCheck check_answers(const Trial& trial, std::span<const ProbeInstance> instances, const ProbeRay& ray,
                          std::span<const ProbeHit> hits, const ProbeAnswer& a, const ProbeAnswer& b) {
  const ProbeHit* const hit_a = find(hits, a);
  const ProbeHit* const hit_b = find(hits, b);
  AnswerCheck check;
  for (const ProbeField& field : probe_fields()) {
    if (bits_of(a, field) == bits_of(b, field)) continue;
    bool right_a = false, right_b = false;
    DifferenceClass tie = DifferenceClass::rounding;
    if (field.kind == ProbeField::Kind::identity) {
      right_a = is_right_primitive(trial, hits, a);
      right_b = is_right_primitive(trial, hits, b);
      tie = class_of_tie(trial, hit_a, hit_b);
    } else {
      right_a = hit_a && is_right_field(instances, ray, *hit_a, field, a);
      right_b = hit_b && is_right_field(instances, ray, *hit_b, field, b);
      // Of a sphere the one may have met the other side.
      if (field.kind == ProbeField::Kind::flag || hit_a != hit_b) tie = DifferenceClass::edge_or_vertex_tie;
    }
    const Ruling ruling = ruling_of(right_a, right_b);
    const AnswerCheck found = {
        .kind = ruling == Ruling::tie ? tie : DifferenceClass::mismatch, .field = &field, .ruling = ruling};
    if (!check.field) check = found;
    if (found.kind == DifferenceClass::rounding) continue;
    // Answers that name different primitives differ in everything else, too.
    return found;
  }
  return check;
}

bool is_right(const Trial& trial, std::span<const ProbeInstance> instances, const ProbeRay& ray,
              std::span<const ProbeHit> hits, const ProbeAnswer& answer) {
  if (!is_right_primitive(trial, hits, answer)) return false;
  if (trial.any_hit || answer.type == AnswerType::miss) return true;
  const ProbeHit* const hit = find(hits, answer);
  const auto fields = probe_fields();
  return std::all_of(fields.begin(), fields.end(), [&](const ProbeField& field) {
    return field.kind == ProbeField::Kind::identity || is_right_field(instances, ray, *hit, field, answer);
  });
}

}  // namespace tandem::compare
