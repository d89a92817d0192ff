#include "compare/metrics/detailed_metrics.hpp"

#include "compare/metrics/ssim.hpp"

namespace tandem::compare {

std::span<const Named<MetricSet>> metric_set_names() {
  static constexpr Named<MetricSet> names[] = {{MetricSet::basic, "basic"}, {MetricSet::all, "all"}};
  return names;
}

DetailedMetrics measure_in_detail(const pathtracer::Image& a, const pathtracer::Image& b, MetricSet set) {
  DetailedMetrics metrics;
  metrics.ulp = ulp_histogram(a, b);
  metrics.relative = relative_error(a, b);
  metrics.ssim = ssim(a, b);
  if (set == MetricSet::all) {
    metrics.flip = flip(a, b);
    metrics.hdr_flip = hdr_flip(a, b);
  }
  metrics.regions = regions(a, b, metrics.flip ? &*metrics.flip : nullptr);
  return metrics;
}

}  // namespace tandem::compare
