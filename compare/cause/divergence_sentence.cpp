#include "compare/cause/divergence_sentence.hpp"

#include <fmt/format.h>

#include "compare/cause/tie.hpp"

namespace tandem::compare {
namespace {

using pathtracer::EventKind;
using pathtracer::PathEvent;
namespace word = pathtracer::event_word;

std::string vector_text(const glm::vec3& v) { return fmt::format("({:.4g}, {:.4g}, {:.4g})", v.x, v.y, v.z); }

/// "a next light sample", "an end".
std::string kind_text(const PathEvent& event) {
  if (event.words[0] == 0) return "nothing";
  if (event.kind() == EventKind::segment) return "the next segment";
  const std::string text = name(event.kind());
  const bool vowel = std::string_view("aeiou").find(text.front()) != std::string_view::npos;
  if (event.kind() == EventKind::end) return "the end of the path";
  return (vowel ? "an " : "a ") + text;
}

std::string roulette_text(const Divergence& divergence) {
  const bool survives = divergence.a.words[word::roulette_survives] != 0;
  return fmt::format("roulette {} on a and {} on b: the number {:.9g} lies within rounding of the threshold {:.9g}.",
                     survives ? "continues the path" : "ends it", survives ? "ends it" : "continues the path",
                     double{unit_interval(divergence.a.words[word::roulette_bits])},
                     divergence.a.number(word::roulette_survival));
}

std::string decision_text(const Divergence& divergence) {
  const bool flipped = divergence.difference_class == DifferenceClass::flipped_decision;
  const char* const cause = flipped ? "moving the segment's state by rounding flips this decision on one device"
                                    : "from the same state, and rounding does not explain it";
  if (!divergence.field)
    return fmt::format("a continues with {}, b with {}: {}.", kind_text(divergence.a), kind_text(divergence.b), cause);
  const EventField& field = *divergence.field;
  if (flipped && divergence.a.kind() == EventKind::roulette) return roulette_text(divergence);
  return fmt::format("the {} of the {} is {} on a and {} on b: {}.", field.name, name(divergence.a.kind()),
                     field_text(field, divergence.a), field_text(field, divergence.b), cause);
}

std::string value_text(const Divergence& divergence) {
  const EventField& field = *divergence.field;
  const std::string what = fmt::format("the {} of the {}", field.name, name(divergence.a.kind()));
  if (divergence.difference_class == DifferenceClass::rounding)
    return fmt::format("{} differs by {} units in the last place ({:.2g} relative): rounding.", what,
                       divergence.ulp_distance, divergence.relative_difference);
  const std::string values = fmt::format("{} is ({}) on a and ({}) on b", what, field_text(field, divergence.a),
                                         field_text(field, divergence.b));
  if (field.tier == FieldTier::observed)
    return fmt::format("{}, for the same hit of the same ray: more than rounding explains.", values);
  return fmt::format("{}, {:.2g} relative, from the same state: more than rounding explains.", values,
                     divergence.relative_difference);
}

}  // namespace

std::string answer_text(const pathtracer::Scene& scene, pathtracer::RayKind kind, std::uint32_t answer) {
  if (kind == pathtracer::RayKind::occlusion) return answer != 0 ? "something" : "nothing";
  if (answer == pathtracer::no_primitive) return "nothing";
  return answer < scene.triangles.size() ? fmt::format("triangle {}", answer)
                                         : fmt::format("sphere {}", answer - scene.triangles.size());
}

std::string sentence_of(const Divergence& divergence) {
  const bool is_value = divergence.field && divergence.field->tier != FieldTier::exact;
  const std::string place =
      divergence.a.kind() == EventKind::camera ? "Camera" : fmt::format("Segment {}", divergence.segment);
  return fmt::format("{}: {}", place, is_value ? value_text(divergence) : decision_text(divergence));
}

std::string sentence_of_answers(const Divergence& divergence, const pathtracer::Scene& scene,
                                const pathtracer::PathId& path) {
  const pathtracer::TracedRay ray = pathtracer::ray_of(path, divergence.a);
  const std::uint32_t b = divergence.b.words[word::ray_answer];
  const auto text = [&](std::uint32_t answer) { return answer_text(scene, ray.kind, answer); };
  const bool occlusion = ray.kind == pathtracer::RayKind::occlusion;
  std::string sentence = fmt::format("Segment {}: the {} from {} {} {} on a and {} on b", divergence.segment,
                                     occlusion ? "shadow ray" : "ray", vector_text(ray.origin),
                                     occlusion ? "finds" : "meets", text(ray.answer), text(b));
  switch (divergence.difference_class) {
    case DifferenceClass::mismatch:
      return fmt::format("{}; the exact answer is {}, and rounding does not explain the difference.", sentence,
                         text(divergence.exact_answer.value_or(pathtracer::no_primitive)));
    case DifferenceClass::grazing_visibility:
      return sentence + " in its way; it grazes an occluder: either is right.";
    case DifferenceClass::coincident_geometry:
      return sentence + "; both lie in the same place: either is right.";
    case DifferenceClass::flipped_decision:
      return sentence + "; the nearer one is transparent, and whether the ray passes it lies within rounding.";
    default: {
      const std::string passing = passing_text(scene, ray, ray.answer, b);
      return fmt::format("{}; {}either is right.", sentence, passing.empty() ? "" : passing + ": ");
    }
  }
}

}  // namespace tandem::compare
