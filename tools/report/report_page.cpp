#include "tools/report/report_page.hpp"

#include <fmt/format.h>

#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "compare/path/alignment.hpp"
#include "compare/path/scene_names.hpp"
#include "compare/report/page.hpp"
#include "compare/report/ranking.hpp"
#include "pathtracer/render/path_recorder.hpp"
#include "tools/report/explanation_report.hpp"

namespace tandem::tools {
namespace {

using pathtracer::PathId;
using pathtracer::PathStart;

/// Pixels that a page lists, and those of them of which it has a path.
constexpr std::size_t ranked_pixels = 10'000;
constexpr std::size_t recorded_pixels = 64;

/// Of each pixel the sample to look at: the first with the worst divergence, else the first that differs, else 0.
std::vector<PathStart> starts_of(compare::Session& session, const compare::Classification* classification,
                                 const std::vector<compare::RankedPixel>& pixels) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, const compare::ClassifiedPath*> classified;
  if (classification != nullptr) {
    for (const compare::ClassifiedPath& path : classification->paths) {
      const compare::ClassifiedPath*& best = classified[{path.path.pixel.x, path.path.pixel.y}];
      if (best == nullptr || path.worst() > best->worst()) best = &path;
    }
  }
  std::vector<PathStart> result;
  for (const compare::RankedPixel& ranked : pixels) {
    PathId path{.pixel = ranked.pixel};
    const auto found = classified.find({path.pixel.x, path.pixel.y});
    if (found != classified.end()) {
      path = found->second->path;
    } else {
      std::vector<PathStart> samples;
      for (std::uint32_t sample = 0; sample < session.job.samples; ++sample)
        samples.push_back({.path = {.pixel = ranked.pixel, .sample = sample}});
      const auto of_a = summarize_paths(session.a.scene(), samples), of_b = summarize_paths(session.b.scene(), samples);
      for (std::size_t i = samples.size(); i-- > 0;)
        if (of_a[i] != of_b[i]) path = samples[i].path;
    }
    result.push_back({.path = path});
  }
  return result;
}

std::vector<compare::RecordedPath> recorded_paths(compare::Session& session,
                                                  const compare::Classification* classification,
                                                  const compare::Ranking& ranking) {
  const std::vector<PathStart> starts =
      starts_of(session, classification, compare::pixels_to_record(ranking, recorded_pixels));
  if (starts.empty()) return {};
  const auto of_a = record_paths(session.a.scene(), starts), of_b = record_paths(session.b.scene(), starts);
  const compare::SceneNames names(session.job.scene);
  std::vector<compare::RecordedPath> result;
  for (std::size_t i = 0; i < starts.size(); ++i)
    result.push_back(
        {.path = starts[i].path, .events = events_json(compare::pair_events(of_a[i], of_b[i]), names).dump()});
  return result;
}

}  // namespace

compare::ComparisonOptions with_metrics_for_page(compare::ComparisonOptions options) {
  if (!options.metrics) options.metrics = compare::MetricSet::all;
  return options;
}

std::string report_page(compare::Session& session, const compare::Comparison& comparison, const std::string& numbers) {
  const compare::Classification* const classification =
      comparison.classification ? &*comparison.classification : nullptr;
  const compare::Ranking ranking =
      compare::rank_pixels(comparison.a.image, comparison.b.image, classification, ranked_pixels);
  const std::optional<compare::DetailedMetrics>& metrics = comparison.detailed_metrics;
  return compare::page({.title = fmt::format("{}: {} against {}", comparison.job.scene, comparison.a.device.name,
                                             comparison.b.device.name),
                        .numbers = numbers,
                        .a = comparison.a.image,
                        .b = comparison.b.image,
                        .flip = metrics && metrics->flip ? &*metrics->flip : nullptr,
                        .classification = classification,
                        .ranking = ranking,
                        // Pictures of other random numbers have no paths that belong together.
                        .paths = comparison.thresholds.tier == compare::Tier::statistical
                                     ? std::vector<compare::RecordedPath>()
                                     : recorded_paths(session, classification, ranking)});
}

}  // namespace tandem::tools
