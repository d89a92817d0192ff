#include "tools/report/metrics_report.hpp"

#include <fmt/format.h>

#include <iterator>
#include <limits>
#include <optional>

namespace tandem::tools {
namespace {

using compare::Region;

/// Wider bins than those of the histogram, for one line: each goes on from the one before to this distance.
constexpr std::uint64_t line_bins[] = {0, 1, 2, 4, 16, 256, 65536, std::numeric_limits<std::uint64_t>::max()};

/// "0: 3060  1: 9  3-4: 2  (largest 4)".
std::string ulp_text(const compare::UlpHistogram& histogram) {
  std::string text;
  std::uint64_t least = 0;
  for (const std::uint64_t most : line_bins) {
    std::uint64_t values = 0;
    for (const compare::UlpBin& bin : histogram.bins) values += bin.least >= least && bin.most <= most ? bin.values : 0;
    if (values != 0) {
      const std::string range = least == most                                 ? fmt::format("{}", most)
                                : most == line_bins[std::size(line_bins) - 1] ? fmt::format("{} and more", least)
                                                                              : fmt::format("{}-{}", least, most);
      fmt::format_to(std::back_inserter(text), "{}: {}  ", range, values);
    }
    least = most + 1;
  }
  return text.empty() ? "no finite values" : fmt::format("{}(largest {})", text, histogram.largest);
}

std::string flip_text(const compare::FlipErrors& errors) {
  return fmt::format("mean {:.6f}, largest {:.6f}", errors.mean, errors.largest);
}

std::string region_text(const Region& region) {
  std::string text = fmt::format("{:9.5f} % bit-equal, RMSE {:.3g}, max {:.3g}", 100.0 * region.metrics.bit_equal,
                                 region.metrics.rmse, region.metrics.max_abs);
  const std::uint64_t non_finite = region.metrics.non_finite_a + region.metrics.non_finite_b;
  if (non_finite != 0) fmt::format_to(std::back_inserter(text), ", {} non-finite", non_finite);
  if (region.flip) fmt::format_to(std::back_inserter(text), ", FLIP {:.6f}", *region.flip);
  return text;
}

nlohmann::ordered_json to_json(const compare::FlipErrors& errors) {
  return {{"mean", errors.mean}, {"max", errors.largest}};
}

nlohmann::ordered_json to_json(const compare::HdrFlipErrors& errors) {
  nlohmann::ordered_json json = to_json(errors.errors);
  json["first_exposure"] = errors.first_exposure;
  json["last_exposure"] = errors.last_exposure;
  json["exposures"] = errors.exposures;
  return json;
}

nlohmann::ordered_json to_json(const Region& region) {
  nlohmann::ordered_json json = {{"row", region.row},
                                 {"column", region.column},
                                 {"x", region.x},
                                 {"y", region.y},
                                 {"width", region.width},
                                 {"height", region.height},
                                 {"bit_equal", region.metrics.bit_equal},
                                 {"rmse", region.metrics.rmse},
                                 {"max_abs", region.metrics.max_abs},
                                 {"non_finite_a", region.metrics.non_finite_a},
                                 {"non_finite_b", region.metrics.non_finite_b}};
  if (region.flip) json["flip"] = *region.flip;
  return json;
}

}  // namespace

std::string table(const compare::DetailedMetrics& metrics) {
  std::string text;
  const auto line = [&](const std::string& name, const std::string& value) {
    fmt::format_to(std::back_inserter(text), "{:<18}{}\n", name, value);
  };
  const compare::RelativeError& relative = metrics.relative;
  line("ULP apart", ulp_text(metrics.ulp));
  line("relative error",
       fmt::format("50 %: {:.3g}  90 %: {:.3g}  99 %: {:.3g}  99.9 %: {:.3g}  (largest {:.3g})", relative.percentile_50,
                   relative.percentile_90, relative.percentile_99, relative.percentile_99_9, relative.largest));
  line("relMSE", fmt::format("{:.6g}", relative.rel_mse));
  line("SSIM", fmt::format("{:.6f}", metrics.ssim));
  if (metrics.flip) line("FLIP", flip_text(*metrics.flip));
  if (metrics.hdr_flip) {
    const compare::HdrFlipErrors& errors = *metrics.hdr_flip;
    line("HDR-FLIP", fmt::format("{} ({} exposures from {:.2f} to {:.2f} stops)", flip_text(errors.errors),
                                 errors.exposures, errors.first_exposure, errors.last_exposure));
  }
  const std::optional<std::size_t> worst = compare::worst_region(metrics.regions);
  line("worst region", worst ? name(metrics.regions[*worst]) : "none: every pixel has the same bits");
  if (metrics.flip) {
    for (const Region& region : metrics.regions) {
      if (region.metrics.bit_equal == 1.0) continue;
      line(fmt::format("  row {}, column {}", region.row + 1, region.column + 1), region_text(region));
    }
  } else if (worst) {
    line("", region_text(metrics.regions[*worst]));
  }
  return text;
}

nlohmann::ordered_json to_json(const compare::DetailedMetrics& metrics) {
  nlohmann::ordered_json json;
  nlohmann::ordered_json bins = nlohmann::ordered_json::array();
  for (const compare::UlpBin& bin : metrics.ulp.bins) {
    bins.push_back({{"least", bin.least}, {"most", bin.most}, {"values", bin.values}});
  }
  json["ulp"] = {{"values", metrics.ulp.values}, {"largest", metrics.ulp.largest}, {"bins", std::move(bins)}};
  json["relative_error"] = {{"p50", metrics.relative.percentile_50},
                            {"p90", metrics.relative.percentile_90},
                            {"p99", metrics.relative.percentile_99},
                            {"p99_9", metrics.relative.percentile_99_9},
                            {"max", metrics.relative.largest}};
  json["rel_mse"] = metrics.relative.rel_mse;
  json["ssim"] = metrics.ssim;
  if (metrics.flip) json["flip"] = to_json(*metrics.flip);
  if (metrics.hdr_flip) json["hdr_flip"] = to_json(*metrics.hdr_flip);
  json["regions"] = nlohmann::ordered_json::array();
  for (const Region& region : metrics.regions) json["regions"].push_back(to_json(region));
  const std::optional<std::size_t> worst = compare::worst_region(metrics.regions);
  json["worst_region"] = worst ? nlohmann::ordered_json(*worst) : nlohmann::ordered_json(nullptr);
  return json;
}

}  // namespace tandem::tools
