#include "tests/faults/fault_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <filesystem>
#include <string_view>
#include <vector>

#include "compare/path/alignment.hpp"
#include "compare/path/event_fields.hpp"
#include "compare/probe/probing.hpp"
#include "pathtracer/load/scene_loader.hpp"
#include "pathtracer/render/path_recorder.hpp"
#include "pathtracer/render/renderer.hpp"
#include "tests/faults/faulty_device.hpp"

namespace tandem::test {
namespace {

using compare::DifferenceClass;

// As small as it can be for every fault to show: pixels, and samples of each.
constexpr std::uint32_t image_side = 32;
constexpr std::uint32_t samples = 2;
constexpr std::uint32_t tile_side = 16;  // so that a picture takes several dispatches
constexpr std::size_t classed_pixels = 16;
constexpr std::size_t surveyed_pixels = 16;
constexpr std::uint32_t spread_path_count = 40;

pathtracer::RenderSettings settings() {
  pathtracer::RenderSettings settings;
  settings.width = settings.height = image_side;
  settings.maximum_tile = tile_side;
  return settings;
}

std::filesystem::path scene_file(const std::string& name) {
  const std::filesystem::path source = TANDEM_SOURCE_DIRECTORY, own = source / "tests/faults/scenes" / name;
  return std::filesystem::exists(own) ? own : source / "scenes" / name;
}

/// Some paths, one pixel each, all over the picture.
std::vector<pathtracer::PathStart> spread_paths() {
  constexpr std::uint32_t pixels = image_side * image_side;
  std::vector<pathtracer::PathStart> starts;
  for (std::uint32_t i = 0; i < spread_path_count; ++i) {
    const std::uint32_t pixel = i * pixels / spread_path_count;
    starts.push_back({.path = {{pixel % image_side, pixel / image_side}, 0}});
  }
  return starts;
}

/// What parts most often, and where first.
class Tally {
 public:
  void add(const std::string& event, const std::string& field, std::uint32_t segment, const std::string& sentence) {
    Entry& entry = entries_[{event, field}];
    if (entry.count == 0) entry.sentence = sentence;
    ++entry.count;
    if (!first_segment_ || segment < *first_segment_) first_segment_ = segment;
  }
  bool empty() const { return entries_.empty(); }
  void report(Finding& finding) const {
    if (entries_.empty()) return;
    const auto most = std::ranges::max_element(entries_, {}, [](const auto& entry) { return entry.second.count; });
    finding.event = most->first.first;
    finding.field = most->first.second;
    finding.sentence = most->second.sentence;
    finding.segment = first_segment_;
  }

 private:
  struct Entry {
    std::uint64_t count = 0;
    std::string sentence;
  };
  std::map<std::pair<std::string, std::string>, Entry> entries_;
  std::optional<std::uint32_t> first_segment_;
};

void worsen(Finding& finding, DifferenceClass found) {
  if (!finding.worst || *finding.worst < found) finding.worst = found;
}

/// An event without what no result depends on.
pathtracer::PathEvent without_observations(pathtracer::PathEvent event) {
  for (const compare::EventField& field : compare::fields_of(event.kind()))
    if (field.tier == compare::FieldTier::observed)
      for (std::size_t i = 0; i < compare::word_count(field.type); ++i) event.words[field.word + i] = 0;
  return event;
}

/// The first event that two recordings do not share, observations aside; the shorter one's length when there is none.
std::size_t first_difference(const pathtracer::PathEvents& a, const pathtracer::PathEvents& b) {
  const std::size_t length = std::min(a.size(), b.size());
  for (std::size_t i = 0; i < length; ++i)
    if (without_observations(a[i]) != without_observations(b[i])) return i;
  return length;
}

/// The segment that an event comes from: a state is what the segment before it left.
std::uint32_t segment_of(const pathtracer::PathEvent& event) {
  const bool is_left = event.kind() == pathtracer::EventKind::segment && event.segment() > 0;
  return is_left ? event.segment() - 1 : event.segment();
}

/// The name of the first field, observations aside, in which two events of a kind differ; "" where the kinds do.
std::string first_field(const pathtracer::PathEvent& a, const pathtracer::PathEvent& b) {
  if (a.kind() != b.kind()) return "";
  for (const compare::EventField& field : compare::fields_of(a.kind()))
    if (field.tier != compare::FieldTier::observed && !compare::is_equal(field, a, b)) return field.name;
  return "";
}

/// Whether `tandem explain` would show the path to part at event `first` of both recordings.
bool is_explained(const pathtracer::PathEvents& a, const pathtracer::PathEvents& b, std::size_t first) {
  const std::vector<compare::EventPair> pairs = compare::pair_events(a, b);
  const std::optional<compare::FirstDifference> named = compare::first_difference(pairs);
  if (!named) return false;
  const compare::EventPair& pair = pairs[named->pair];
  const bool is_first = pair.a == a[first] || (first < b.size() && pair.b == b[first]);
  return is_first && (named->field == nullptr || first_field(a[first], b[first]) == named->field->name);
}

/// Whether what is said of where a path first parts agrees with the bare recordings; "" or what does not.
std::string check_against_recordings(const compare::ClassifiedPath& path, pathtracer::SceneOnDevice& a,
                                     pathtracer::SceneOnDevice& b) {
  const std::vector<pathtracer::PathStart> start = {{.path = path.path}};
  const pathtracer::PathEvents events_a = record_paths(a, start).front();
  const pathtracer::PathEvents events_b = record_paths(b, start).front();
  const compare::Divergence& divergence = path.divergences.front();
  const std::string place =
      fmt::format("pixel {},{} sample {}", path.path.pixel.x, path.path.pixel.y, path.path.sample);
  if (divergence.field != nullptr && divergence.field->tier == compare::FieldTier::observed) {
    const auto observed = compare::observed_differences(compare::pair_events(events_a, events_b));
    return observed.differing > 0 ? "" : place + " shows the same hits in both recordings";
  }
  const std::size_t first = first_difference(events_a, events_b);
  if (first >= events_a.size()) return place + " does not part in a's recording";
  if (divergence.event_index != first || divergence.segment != segment_of(events_a[first]))
    return fmt::format("{} parts at event {}, not at event {} of segment {}", place, first, divergence.event_index,
                       divergence.segment);
  return is_explained(events_a, events_b, first) ? "" : place + " is explained by another event or field";
}

/// Whether the recordings of paths all over the picture have the same bits, observations included.
bool same_recordings(pathtracer::SceneOnDevice& a, pathtracer::SceneOnDevice& b) {
  return record_paths(a, spread_paths()) == record_paths(b, spread_paths());
}

/// Adds the result of a classification to the finding.
/// @param mismatches_only for a harmful fault, of which only mismatches count; else every divergence counts
void take(const compare::Classification& found, bool mismatches_only, Finding& finding) {
  Tally tally;
  for (const compare::ClassifiedPath& path : found.paths) {
    for (const compare::Divergence& divergence : path.divergences) worsen(finding, divergence.difference_class);
    const auto first = std::ranges::find_if(path.divergences, [&](const compare::Divergence& divergence) {
      return !mismatches_only || divergence.difference_class == DifferenceClass::mismatch;
    });
    if (first == path.divergences.end()) continue;
    tally.add(compare::name(first->a.kind()), first->field != nullptr ? first->field->name : "kind", first->segment,
              first->sentence);
  }
  const bool wrong_sums = std::ranges::any_of(found.pixels, [](const auto& pixel) { return pixel.wrong_sum != 0; });
  if (wrong_sums) worsen(finding, DifferenceClass::mismatch);
  finding.differing_pixels = found.differing_pixels;
  if (tally.empty() && !wrong_sums) return;
  finding.found_by = found.differing_pixels > 0 ? Finder::picture : Finder::survey;
  tally.report(finding);
}

void take(const compare::Probing& found, Finding& finding) {
  Tally tally;
  const char* first_trial = nullptr;
  for (const compare::ProbeDifference& difference : found.differences) {
    worsen(finding, difference.kind);
    if (difference.kind != DifferenceClass::mismatch) continue;
    if (first_trial == nullptr) first_trial = difference.trial;
    if (std::string_view(first_trial) == difference.trial) tally.add(difference.trial, difference.field->name, 0, "");
  }
  if (tally.empty()) return;
  finding.found_by = Finder::probes;
  tally.report(finding);
  finding.segment.reset();
}

/// What of the finding the fault does not declare; "" when nothing.
std::string problem_of(const Fault& fault, const Finding& finding) {
  const bool mismatch = finding.worst == DifferenceClass::mismatch;
  if (mismatch && !fault.harmful)
    return fmt::format("a mismatch, by {}: {} {}", name(finding.found_by), finding.event, finding.field);
  if (!mismatch && fault.harmful) return "no mismatch";
  if (finding.found_by != fault.finder)
    return fmt::format("found by {} and not by {}", name(finding.found_by), name(fault.finder));
  if (!fault.harmful) return "";
  if (finding.event != fault.event) return fmt::format("the event is '{}' and not '{}'", finding.event, fault.event);
  if (!fault.fields.empty() && std::ranges::find(fault.fields, finding.field) == fault.fields.end())
    return fmt::format("the field is '{}' and not '{}'", finding.field, fault.fields.front());
  if (finding.segment.value_or(fault.segment) != fault.segment)
    return fmt::format("the first segment is {} and not {}", *finding.segment, fault.segment);
  return "";
}

}  // namespace

struct FaultRunner::Reference {
  pathtracer::Scene scene;
  pathtracer::Renderer a;
  pathtracer::SceneOnDevice arbiter;
  pathtracer::Image image;
  std::vector<compare::PathRay> rays;  ///< for probes
};

FaultRunner::FaultRunner(rhi::DeviceHandle device, rhi::DeviceHandle arbiter)
    : device_(std::move(device)), arbiter_(std::move(arbiter)) {}
FaultRunner::~FaultRunner() = default;

FaultRunner::Reference& FaultRunner::reference(const std::string& scene, pathtracer::TracingMode form) {
  std::unique_ptr<Reference>& known = references_[{scene, form}];
  if (known) return *known;
  pathtracer::Scene loaded = pathtracer::load_scene(scene_file(scene));
  pathtracer::Renderer a(device_, loaded, settings(), form);
  pathtracer::SceneOnDevice arbiter(arbiter_, loaded, settings(), form);
  a.render(samples);
  pathtracer::Image image = a.image();

  const std::vector<pathtracer::PathStart> starts = spread_paths();
  std::vector<compare::PathRay> rays;
  const std::vector<pathtracer::PathEvents> recorded = record_paths(a.scene(), starts);
  for (std::size_t i = 0; i < starts.size(); ++i) {
    std::uint32_t index = 0;
    for (const pathtracer::TracedRay& ray : pathtracer::rays_of(starts[i].path, recorded[i]))
      rays.push_back({starts[i].path, index++, ray});
  }
  known = std::make_unique<Reference>(
      Reference{std::move(loaded), std::move(a), std::move(arbiter), std::move(image), std::move(rays)});
  return *known;
}

Finding FaultRunner::run(const Fault& fault) {
  const auto begin = std::chrono::steady_clock::now();
  Finding finding;
  Reference& truth = reference(fault.scene, fault.form);
  const rhi::DeviceHandle faulty = faulty_device(device_, fault.edits);
  pathtracer::Renderer b(faulty, truth.scene, settings(), fault.form);
  b.render(samples);
  const compare::Classification found =
      compare::classify({truth.a.scene(), b.scene(), truth.arbiter, truth.scene}, truth.image, b.image(), samples,
                        {.pixel_limit = classed_pixels, .survey_pixels = surveyed_pixels});
  take(found, fault.harmful, finding);
  for (const compare::ClassifiedPath& path : found.paths) {
    if (!finding.problem.empty()) break;
    if (!path.divergences.empty()) finding.problem = check_against_recordings(path, truth.a.scene(), b.scene());
  }
  if (finding.found_by == Finder::nobody && !fault.harmful && !same_recordings(truth.a.scene(), b.scene())) {
    // What devices may report otherwise is no divergence.
    finding.found_by = Finder::survey;
    finding.worst = DifferenceClass::rounding;
  }
  // Of one that does no harm, they must not say anything else.
  if (finding.found_by == Finder::nobody || (!fault.harmful && finding.worst != DifferenceClass::mismatch))
    take(compare::probe(*device_, *faulty, truth.scene, truth.rays, fault.form, fault.form), finding);
  if (finding.problem.empty()) finding.problem = problem_of(fault, finding);
  finding.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return finding;
}

}  // namespace tandem::test
