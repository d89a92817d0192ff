#pragma once

#include <optional>
#include <span>
#include <vector>

#include "compare/image/flip/flip.hpp"
#include "compare/image/ulp_histogram.hpp"
#include "compare/metrics/regions.hpp"
#include "compare/metrics/relative_error.hpp"
#include "pathtracer/scene/settings.hpp"

namespace tandem::compare {

/// How much is measured.
enum class MetricSet {
  basic,  ///< all but FLIP, in a fraction of a second
  all     ///< FLIP too, which takes seconds for a million pixels
};

/// "basic" and "all".
std::span<const Named<MetricSet>> metric_set_names();

/// What docs/guide/metrics.md describes beyond Metrics.
struct DetailedMetrics {
  UlpHistogram ulp;
  RelativeError relative;
  double ssim = 1.0;
  std::optional<FlipErrors> flip;  ///< both with MetricSet::all only
  std::optional<HdrFlipErrors> hdr_flip;
  std::vector<Region> regions;  ///< 4 x 4
};

/// Image a is the reference. Throws as check_pair.
DetailedMetrics measure_in_detail(const pathtracer::Image& a, const pathtracer::Image& b, MetricSet set);

}  // namespace tandem::compare
