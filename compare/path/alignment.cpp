#include "compare/path/alignment.hpp"

#include <algorithm>

namespace tandem::compare {
namespace {

using pathtracer::EventKind;
using pathtracer::PathEvent;

bool belong_together(const PathEvent& a, const PathEvent& b) {
  using pathtracer::event_word::ray_kind;
  return a.kind() == b.kind() && (a.kind() != EventKind::ray || a.words[ray_kind] == b.words[ray_kind]);
}

/// The events that begin the list and are of one segment.
std::span<const PathEvent> first_segment(std::span<const PathEvent> events, std::uint32_t segment) {
  const auto end = std::ranges::find_if(events, [&](const PathEvent& event) { return event.segment() != segment; });
  return events.first(static_cast<std::size_t>(end - events.begin()));
}

/// By a longest common subsequence.
void pair_segment(std::span<const PathEvent> a, std::span<const PathEvent> b, std::vector<EventPair>& pairs) {
  const std::size_t width = b.size() + 1;
  // lengths[i * width + j]: how many pairs there can be from a[i] and b[j] on.
  std::vector<std::size_t> lengths((a.size() + 1) * width, 0);
  for (std::size_t i = a.size(); i-- > 0;) {
    for (std::size_t j = b.size(); j-- > 0;) {
      lengths[i * width + j] = belong_together(a[i], b[j])
                                   ? lengths[(i + 1) * width + j + 1] + 1
                                   : std::max(lengths[(i + 1) * width + j], lengths[i * width + j + 1]);
    }
  }
  std::size_t i = 0, j = 0;
  while (i < a.size() || j < b.size()) {
    if (i < a.size() && j < b.size() && belong_together(a[i], b[j])) {
      pairs.push_back({a[i++], b[j++]});
    } else if (j == b.size() || (i < a.size() && lengths[(i + 1) * width + j] >= lengths[i * width + j + 1])) {
      pairs.push_back({a[i++], std::nullopt});
    } else {
      pairs.push_back({std::nullopt, b[j++]});
    }
  }
}

}  // namespace

std::vector<EventPair> pair_events(std::span<const PathEvent> a, std::span<const PathEvent> b) {
  std::vector<EventPair> pairs;
  pairs.reserve(std::max(a.size(), b.size()));
  while (!a.empty() || !b.empty()) {
    const std::uint32_t segment = a.empty()   ? b.front().segment()
                                  : b.empty() ? a.front().segment()
                                              : std::min(a.front().segment(), b.front().segment());
    const std::span<const PathEvent> of_a = first_segment(a, segment), of_b = first_segment(b, segment);
    pair_segment(of_a, of_b, pairs);
    a = a.subspan(of_a.size());
    b = b.subspan(of_b.size());
  }
  return pairs;
}

bool differs(const EventPair& pair, const EventField& field) {
  return !pair.a || !pair.b || !is_equal(field, *pair.a, *pair.b);
}

bool differs(const EventPair& pair) {
  return !pair.a || !pair.b || std::ranges::any_of(fields_of(pair.kind()), [&](const EventField& field) {
    return field.tier != FieldTier::observed && differs(pair, field);
  });
}

std::optional<FirstDifference> first_difference(std::span<const EventPair> pairs) {
  const auto found = std::ranges::find_if(pairs, [](const EventPair& pair) { return differs(pair); });
  if (found == pairs.end()) return std::nullopt;
  FirstDifference first{.pair = static_cast<std::size_t>(found - pairs.begin())};
  if (!found->a || !found->b) return first;
  const std::span<const EventField> fields = fields_of(found->kind());
  const auto field = std::ranges::find_if(
      fields, [&](const EventField& each) { return each.tier != FieldTier::observed && differs(*found, each); });
  first.field = &*field;
  first.ulp_distance = ulp_distance(*field, *found->a, *found->b);
  first.relative_difference = relative_difference(*field, *found->a, *found->b);
  return first;
}

ObservedDifferences observed_differences(std::span<const EventPair> pairs) {
  ObservedDifferences result;
  for (const EventPair& pair : pairs) {
    if (differs(pair)) continue;
    for (const EventField& field : fields_of(pair.kind())) {
      if (field.tier != FieldTier::observed) continue;
      result.fields += 1;
      result.differing += differs(pair, field) ? 1u : 0u;
      result.relative_difference = std::max(result.relative_difference, relative_difference(field, *pair.a, *pair.b));
    }
  }
  return result;
}

}  // namespace tandem::compare
