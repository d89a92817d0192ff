#include "compare/path/recording_difference.hpp"

#include <algorithm>

namespace tandem::compare {

using pathtracer::EventKind;
using pathtracer::PathEvent;

std::optional<EventPlace> next_difference(std::span<const PathEvent> a, std::span<const PathEvent> b, EventPlace from) {
  for (; from.event < std::max(a.size(), b.size()); from = {from.event + 1, 0}) {
    if (from.event >= a.size() || from.event >= b.size()) return EventPlace{from.event, 0};
    const PathEvent &event_a = a[from.event], &event_b = b[from.event];
    if (event_a.kind() != event_b.kind()) return EventPlace{from.event, 0};
    const std::span<const EventField> fields = fields_of(event_a.kind());
    for (; from.field < fields.size(); ++from.field)
      if (!is_equal(fields[from.field], event_a, event_b)) return from;
  }
  return std::nullopt;
}

const EventField* field_at(std::span<const PathEvent> a, std::span<const PathEvent> b, EventPlace place) {
  if (place.event >= a.size() || place.event >= b.size()) return nullptr;
  if (a[place.event].kind() != b[place.event].kind()) return nullptr;
  const std::span<const EventField> fields = fields_of(a[place.event].kind());
  return place.field < fields.size() ? &fields[place.field] : nullptr;
}

std::optional<EventPlace> first_significant_difference(std::span<const PathEvent> a, std::span<const PathEvent> b) {
  std::optional<EventPlace> place = next_difference(a, b);
  while (place) {
    const EventField* const field = field_at(a, b, *place);
    if (!field || field->tier != FieldTier::observed) return place;
    place = next_difference(a, b, {place->event, place->field + 1});
  }
  return std::nullopt;
}

std::vector<std::size_t> segment_begins(std::span<const PathEvent> events) {
  std::vector<std::size_t> begins;
  for (std::size_t i = 0; i < events.size(); ++i)
    if (events[i].kind() == EventKind::segment) begins.push_back(i);
  return begins;
}

}  // namespace tandem::compare
