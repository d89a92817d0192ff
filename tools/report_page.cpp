#include "tools/report_page.hpp"

#include <fmt/format.h>

#include "compare/report/page.hpp"
#include "compare/report/ranking.hpp"
#include "tools/device_json.hpp"

namespace tandem::tools {
namespace {

/// Pixels that a page lists.
constexpr std::size_t ranked_pixels = 10'000;

}  // namespace

std::string report_page(Comparison& comparison, const DiffReport& report) {
  const compare::Ranking ranking = compare::rank_pixels(report.a.image, report.b.image, nullptr, ranked_pixels);
  const std::optional<compare::DetailedMetrics>& metrics = report.detailed_metrics;
  return compare::page(
      {.title = fmt::format("{}: {} against {}", comparison.summary.scene, report.a.device.name, report.b.device.name),
       .numbers = json_text(to_json(report)),
       .a = report.a.image,
       .b = report.b.image,
       .flip = metrics && metrics->flip ? &*metrics->flip : nullptr,
       .ranking = ranking});
}

}  // namespace tandem::tools
