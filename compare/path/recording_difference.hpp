#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "compare/path/event_fields.hpp"
#include "pathtracer/render/path_event.hpp"

/// Two recordings side by side.
namespace tandem::compare {

/// A place in two recordings.
struct EventPlace {
  std::size_t event = 0;  ///< index in both recordings
  std::size_t field = 0;  ///< index in fields_of the event's kind; of events of different kinds 0
};

/// The first field at or after `from`, in the order of events and of fields_of, whose bits differ. Where kinds differ,
/// or one of the recordings has ended, that event. Nothing when all is the same.
std::optional<EventPlace> next_difference(std::span<const pathtracer::PathEvent> a,
                                          std::span<const pathtracer::PathEvent> b, EventPlace from = {});

/// The field of the place; null where the recordings have no event of the same kind there.
const EventField* field_at(std::span<const pathtracer::PathEvent> a, std::span<const pathtracer::PathEvent> b,
                           EventPlace place);

/// As next_difference from the beginning, but without observed fields, on which no path's course depends.
std::optional<EventPlace> first_significant_difference(std::span<const pathtracer::PathEvent> a,
                                                       std::span<const pathtracer::PathEvent> b);

/// Where the segments of a recording begin: the indices of its events of kind segment.
std::vector<std::size_t> segment_begins(std::span<const pathtracer::PathEvent> events);

}  // namespace tandem::compare
