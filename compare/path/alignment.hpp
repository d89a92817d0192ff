#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "compare/path/event_fields.hpp"
#include "pathtracer/render/path_event.hpp"

/// Two recordings of the same path side by side.
namespace tandem::compare {

/// Two events that belong together, or one that only one device has.
struct EventPair {
  std::optional<pathtracer::PathEvent> a, b;  ///< at least one of them

  std::uint32_t segment() const { return a ? a->segment() : b->segment(); }
  pathtracer::EventKind kind() const { return a ? a->kind() : b->kind(); }
  /// The one that there is: a's, if both are.
  const pathtracer::PathEvent& event() const { return a ? *a : *b; }
};

/// Pairs as many events of the same segment and kind (rays: of the same purpose) as possible without changing their
/// order. The result has every event of both recordings once, segment by segment, and within a segment in the order
/// of its own recording.
std::vector<EventPair> pair_events(std::span<const pathtracer::PathEvent> a, std::span<const pathtracer::PathEvent> b);

/// Whether the field has not the same bits in both, or only one device has the event.
bool differs(const EventPair& pair, const EventField& field);

/// Whether a field does that is not just observed.
bool differs(const EventPair& pair);

/// Where two recordings begin to differ.
struct FirstDifference {
  std::size_t pair = 0;               ///< index into the pairs
  const EventField* field = nullptr;  ///< the first that differs; null where only one device has the event
  std::uint32_t ulp_distance = 0;     ///< of the field
  double relative_difference = 0;     ///< likewise
};

/// The first pair that differs; nothing when the paths are the same. What is just observed does not count.
std::optional<FirstDifference> first_difference(std::span<const EventPair> pairs);

/// How what devices report of hits differs, although no result depends on it.
struct ObservedDifferences {
  std::size_t fields = 0;          ///< observed fields of events that are the same in all else
  std::size_t differing = 0;       ///< of them
  double relative_difference = 0;  ///< the largest; of barycentrics as they are
};
ObservedDifferences observed_differences(std::span<const EventPair> pairs);

}  // namespace tandem::compare
