#include "compare/cause/path_classifier.hpp"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <optional>
#include <utility>

#include "compare/cause/arbitration.hpp"
#include "compare/cause/divergence_sentence.hpp"
#include "compare/cause/perturbation.hpp"
#include "compare/cause/segment_classifier.hpp"
#include "compare/path/recording_difference.hpp"
#include "pathtracer/render/device_scene.hpp"
#include "pathtracer/render/path_recorder.hpp"
#include "pathtracer/render/ray_tracer.hpp"

namespace tandem::compare {
namespace {

using pathtracer::EventKind;
using pathtracer::PathEvent;
using pathtracer::PathEvents;
using pathtracer::PathId;
using pathtracer::PathStart;
using pathtracer::PathSummary;
using pathtracer::Scene;
using pathtracer::SceneOnDevice;
namespace word = pathtracer::event_word;

/// Segments whose variations are in memory at once: some 100 KB each.
constexpr std::size_t segments_at_once = 256;

/// A recording of so many segments and no more ends with an event that says so and nothing else.
void drop_limit(PathEvents& events) {
  if (!events.empty() && events.back().kind() == EventKind::end &&
      events.back().words[word::end_reason] == static_cast<std::uint32_t>(pathtracer::EndReason::limit))
    events.pop_back();
}

/// The segments of recordings, the way from the camera to the first among them, and what b makes of each.
std::vector<ClassifiedSegment> segments_of(SceneOnDevice& b, std::span<const PathId> paths,
                                           const std::vector<PathEvents>& recordings) {
  std::vector<ClassifiedSegment> segments;
  std::vector<PathStart> starts;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    const std::span<const PathEvent> events = recordings[i];
    const std::vector<std::size_t> begins = segment_begins(events);
    const auto add = [&](std::size_t first, std::size_t last, PathStart start) {
      segments.push_back({.path = paths[i], .first_event = first, .a = events.subspan(first, last - first), .b = {}});
      starts.push_back(std::move(start));
    };
    const auto end_after = [&](std::size_t begin) { return begin < begins.size() ? begins[begin] + 1 : events.size(); };
    add(0, end_after(0), {.path = paths[i], .state = {}, .segment_count = 0});
    for (std::size_t j = 0; j < begins.size(); ++j)
      add(begins[j], end_after(j + 1), {.path = paths[i], .state = events[begins[j]], .segment_count = 1});
  }
  std::vector<PathEvents> recorded = pathtracer::record_paths(b, starts);
  for (std::size_t i = 0; i < segments.size(); ++i) {
    drop_limit(recorded[i]);
    segments[i].b = std::move(recorded[i]);
    // How many rays were traced before is no part of the state.
    PathEvents& events = segments[i].b;
    if (!events.empty() && !segments[i].a.empty() && events.back().kind() == EventKind::end &&
        segments[i].a.back().kind() == EventKind::end)
      events.back().words[word::end_ray_count] = segments[i].a.back().words[word::end_ray_count];
  }
  return segments;
}

/// Recordings of the perturbed states of segments on a device, variation_count for each.
std::vector<PathEvents> variations_on(SceneOnDevice& device, std::span<ClassifiedSegment* const> segments) {
  std::vector<PathStart> starts;
  for (const ClassifiedSegment* segment : segments)
    for (const PathEvent& state : perturbed_states(segment->a.front()))
      starts.push_back({.path = segment->path, .state = state, .segment_count = 1});
  std::vector<PathEvents> recorded = pathtracer::record_paths(device, starts);
  std::for_each(recorded.begin(), recorded.end(), drop_limit);
  return recorded;
}

/// Classifies segments by what both devices make of perturbed states, and returns those that need the arbiter then.
std::vector<ClassifiedSegment*> classify_by_variations(const Devices& devices, const Scene& scene,
                                                       std::span<ClassifiedSegment* const> segments) {
  std::vector<ClassifiedSegment*> disputed;
  for (std::size_t first = 0; first < segments.size(); first += segments_at_once) {
    const auto some = segments.subspan(first, std::min(segments_at_once, segments.size() - first));
    std::vector<PathEvents> on_a = variations_on(devices.a, some), on_b = variations_on(devices.b, some);
    for (std::size_t i = 0; i < some.size(); ++i) {
      const auto own = [&](std::vector<PathEvents>& all) {
        const auto begin = std::make_move_iterator(all.begin() + static_cast<std::ptrdiff_t>(i * variation_count));
        return std::vector<PathEvents>(begin, begin + static_cast<std::ptrdiff_t>(variation_count));
      };
      const Variations variations{.a = own(on_a), .b = own(on_b)};
      if (classify_segment(*some[i], scene, &variations) == Pending::arbiter) disputed.push_back(some[i]);
    }
  }
  return disputed;
}

void resolve_by_arbiter(const Devices& devices, const Scene& scene, std::span<ClassifiedSegment* const> segments) {
  std::vector<Dispute> disputes;
  std::vector<std::size_t> ends;
  for (const ClassifiedSegment* segment : segments) {
    for (const Dispute& dispute : disputes_of(*segment)) disputes.push_back(dispute);
    ends.push_back(disputes.size());
  }
  if (disputes.empty()) return;
  const PixelFootprint footprint = footprint_of(devices.a.camera(), devices.a.settings().height);
  const std::vector<Arbitration> arbitrations =
      arbitrate(disputes, scene, footprint,
                [&](std::span<const pathtracer::TracedRay> rays) { return pathtracer::trace(devices.arbiter, rays); });
  std::size_t begin = 0;
  for (std::size_t i = 0; i < segments.size(); begin = ends[i++])
    resolve(*segments[i], scene, std::span(arbitrations).subspan(begin, ends[i] - begin));
}

/// A path of which b does something else than it does from the state of each segment by itself: a mismatch.
Divergence hidden_divergence(std::span<const PathEvent> a, std::span<const PathEvent> b) {
  const std::optional<EventPlace> place = first_significant_difference(a, b);
  Divergence divergence;
  if (place) {
    divergence.event_index = place->event;
    if (place->event < a.size()) divergence.a = a[place->event];
    if (place->event < b.size()) divergence.b = b[place->event];
    divergence.field = field_at(a, b, *place);
    divergence.segment = divergence.a.segment();
    if (divergence.field) {
      divergence.ulp_distance = ulp_distance(*divergence.field, divergence.a, divergence.b);
      divergence.relative_difference = relative_difference(*divergence.field, divergence.a, divergence.b);
    }
    divergence.sentence = sentence_of(divergence);
  } else {
    divergence.sentence = "The path has other results than its recording: one of the devices does not repeat itself.";
  }
  return divergence;
}

/// Paths without a divergence so far that are still not the same as a whole.
void find_hidden_divergences(const Devices& devices, std::span<const PathEvents> recordings,
                             std::vector<ClassifiedPath>& paths) {
  std::vector<PathStart> starts;
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    if (!paths[i].divergences.empty()) continue;
    starts.push_back({.path = paths[i].path});
    indices.push_back(i);
  }
  if (starts.empty()) return;
  const std::vector<PathSummary> a = pathtracer::summarize_paths(devices.a, starts),
                                 b = pathtracer::summarize_paths(devices.b, starts);
  for (std::size_t i = 0; i < starts.size(); ++i) {
    if (a[i] == b[i]) continue;
    const std::vector<PathEvents> whole = pathtracer::record_paths(devices.b, {&starts[i], 1});
    paths[indices[i]].divergences.push_back(hidden_divergence(recordings[indices[i]], whole.front()));
  }
}

}  // namespace

std::vector<ClassifiedPath> classify_paths(const Devices& devices, const Scene& scene, std::span<const PathId> paths) {
  std::vector<PathStart> starts;
  for (const PathId& path : paths) starts.push_back({.path = path});
  const std::vector<PathEvents> recordings = pathtracer::record_paths(devices.a, starts);
  std::vector<ClassifiedSegment> segments = segments_of(devices.b, paths, recordings);

  std::vector<ClassifiedSegment*> undecided, disputed;
  for (ClassifiedSegment& segment : segments) {
    const Pending pending = classify_segment(segment, scene, nullptr);
    if (pending == Pending::variations) undecided.push_back(&segment);
    if (pending == Pending::arbiter) disputed.push_back(&segment);
  }
  const std::vector<ClassifiedSegment*> more = classify_by_variations(devices, scene, undecided);
  disputed.insert(disputed.end(), more.begin(), more.end());
  resolve_by_arbiter(devices, scene, disputed);

  std::vector<ClassifiedPath> result;
  auto segment = segments.begin();
  for (const PathId& path : paths) {
    ClassifiedPath& classified = result.emplace_back(ClassifiedPath{.path = path, .divergences = {}});
    for (bool first = true; segment != segments.end() && (first || has_state(*segment)); ++segment, first = false)
      std::move(segment->divergences.begin(), segment->divergences.end(), std::back_inserter(classified.divergences));
  }
  find_hidden_divergences(devices, recordings, result);
  return result;
}

std::vector<ClassifiedPath> classify_paths(const Devices& devices, std::span<const PathId> paths) {
  return classify_paths(devices, pathtracer::in_device_order(devices.scene), paths);
}

}  // namespace tandem::compare
