#include "compare/cause/segment_classifier.hpp"

#include <cmath>
#include <string_view>
#include <utility>

#include "compare/cause/divergence_sentence.hpp"
#include "compare/cause/tie.hpp"

namespace tandem::compare {
namespace {

using pathtracer::EventKind;
using pathtracer::PathEvent;
namespace word = pathtracer::event_word;

/// The event of the place; an empty one where the recording has ended.
PathEvent event_at(std::span<const PathEvent> events, EventPlace place) {
  return place.event < events.size() ? events[place.event] : PathEvent{};
}

Divergence divergence_at(const ClassifiedSegment& segment, DifferenceClass difference_class) {
  Divergence divergence{.difference_class = difference_class,
                        .segment = segment.a.empty() ? 0 : segment.a.front().segment(),
                        .event_index = segment.first_event + segment.place.event,
                        .a = event_at(segment.a, segment.place),
                        .b = event_at(segment.b, segment.place),
                        .field = field_at(segment.a, segment.b, segment.place)};
  if (divergence.field) {
    divergence.ulp_distance = ulp_distance(*divergence.field, divergence.a, divergence.b);
    divergence.relative_difference = relative_difference(*divergence.field, divergence.a, divergence.b);
  }
  return divergence;
}

void add(ClassifiedSegment& segment, DifferenceClass difference_class) {
  if (difference_class == DifferenceClass::rounding && std::exchange(segment.has_rounding, true)) return;
  Divergence divergence = divergence_at(segment, difference_class);
  divergence.sentence = sentence_of(divergence);
  segment.divergences.push_back(std::move(divergence));
}

bool is_answer(const EventField& field, EventKind kind) {
  return kind == EventKind::ray && field.word == word::ray_answer;
}

/// Whether both devices did with roulette's number what their own probability says; the probabilities are the same
/// within rounding, or their difference would have been classified before.
bool is_flipped_roulette(const PathEvent& a, const PathEvent& b) {
  if (a.kind() != EventKind::roulette || a.words[word::roulette_bits] != b.words[word::roulette_bits]) return false;
  const auto follows_rule = [](const PathEvent& event) {
    const bool survives = unit_interval(event.words[word::roulette_bits]) < event.number(word::roulette_survival);
    return survives == (event.words[word::roulette_survives] != 0);
  };
  return follows_rule(a) && follows_rule(b);
}

}  // namespace

bool has_state(const ClassifiedSegment& segment) {
  return !segment.a.empty() && segment.a.front().kind() == EventKind::segment;
}

Pending classify_segment(ClassifiedSegment& segment, const pathtracer::Scene& scene, const Variations* variations) {
  while (const std::optional<EventPlace> found = next_difference(segment.a, segment.b, segment.place)) {
    segment.place = *found;
    const EventField* const field = field_at(segment.a, segment.b, *found);
    const PathEvent a = event_at(segment.a, *found), b = event_at(segment.b, *found);
    const auto go_on = [&] { ++segment.place.field; };
    if (field && field->tier == FieldTier::observed) {
      if (!is_report_within_rounding(scene, a, b, field->word, field->tolerance))
        add(segment, DifferenceClass::mismatch);
      go_on();
      continue;
    }
    if (field && field->tier == FieldTier::carried && relative_difference(*field, a, b) <= field->tolerance) {
      add(segment, DifferenceClass::rounding);
      go_on();
      continue;
    }
    if (field && is_answer(*field, a.kind())) return Pending::arbiter;
    if (field && field->word == word::roulette_survives && is_flipped_roulette(a, b)) {
      add(segment, DifferenceClass::flipped_decision);
      return Pending::nothing;
    }
    // Rounding cannot explain what depends on no state, nor what b has not recorded.
    if (!has_state(segment) || found->event == 0 || found->event >= segment.b.size() ||
        (field && field->type == FieldType::bits)) {
      add(segment, DifferenceClass::mismatch);
      return Pending::nothing;
    }
    if (!variations) return Pending::variations;
    if (field && field->tier == FieldTier::carried && explains_value(*variations, segment.a, segment.b, *found)) {
      add(segment, DifferenceClass::rounding);
      go_on();
      continue;
    }
    const bool is_decision = !field || field->tier == FieldTier::exact;
    add(segment, is_decision && explains_decision(*variations, segment.a, segment.b, *found)
                     ? DifferenceClass::flipped_decision
                     : DifferenceClass::mismatch);
    return Pending::nothing;
  }
  return Pending::nothing;
}

std::vector<Dispute> disputes_of(const ClassifiedSegment& segment) {
  const PathEvent &a = segment.a[segment.place.event], &b = segment.b[segment.place.event];
  const pathtracer::TracedRay ray_a = pathtracer::ray_of(segment.path, a), ray_b = pathtracer::ray_of(segment.path, b);
  const auto dispute = [&](const pathtracer::TracedRay& ray, std::uint32_t answer_a, std::uint32_t answer_b) {
    return Dispute{.ray = ray, .answer_a = answer_a, .answer_b = answer_b};
  };
  if (ray_a.origin == ray_b.origin && ray_a.direction == ray_b.direction && ray_a.t_max == ray_b.t_max)
    return {dispute(ray_a, ray_a.answer, ray_b.answer)};
  return {dispute(ray_a, ray_a.answer, ray_a.answer), dispute(ray_b, ray_b.answer, ray_b.answer)};
}

void resolve(ClassifiedSegment& segment, const pathtracer::Scene& scene, std::span<const Arbitration> arbitrations) {
  bool tie = true;
  for (const Arbitration& arbitration : arbitrations) tie = tie && arbitration.ruling == Ruling::tie;
  Divergence divergence = divergence_at(segment, DifferenceClass::mismatch);
  const pathtracer::TracedRay ray = pathtracer::ray_of(segment.path, divergence.a);
  const std::uint32_t answer_b = divergence.b.words[word::ray_answer];
  if (tie) divergence.difference_class = class_of_tie(scene, ray, ray.answer, answer_b);
  divergence.exact_answer = arbitrations.front().exact_answer;
  divergence.sentence = sentence_of_answers(divergence, scene, segment.path);
  segment.divergences.push_back(std::move(divergence));
}

}  // namespace tandem::compare
