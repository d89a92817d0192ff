#include "compare/verdict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tandem::compare {

Verdict judge(const Metrics& metrics, const Tolerance& tolerance) {
  Verdict verdict;
  const auto require = [&](bool holds, std::string otherwise) {
    if (!holds) verdict.reasons.push_back(std::move(otherwise));
  };
  const auto require_finite = [&](char image, std::uint64_t count) {
    require(count <= tolerance.non_finite,
            fmt::format("Image {} has {} pixels with a NaN or an infinity; {} may have.", image, count,
                        tolerance.non_finite == 0 ? std::string("none") : std::to_string(tolerance.non_finite)));
  };
  require_finite('a', metrics.non_finite_a);
  require_finite('b', metrics.non_finite_b);
  require(metrics.within_1e3 >= tolerance.within_1e3,
          fmt::format("Only {:.4f} % of the pixels are within 1e-3 relative; at least {:g} % must be.",
                      100.0 * metrics.within_1e3, 100.0 * tolerance.within_1e3));
  require(metrics.bit_equal >= tolerance.bit_equal,
          fmt::format("Only {:.4f} % of the pixels are bit-equal; at least {:g} % must be.", 100.0 * metrics.bit_equal,
                      100.0 * tolerance.bit_equal));
  // Without a division, so that two black images have equal means.
  const double larger_mean = std::max(std::abs(metrics.mean_a), std::abs(metrics.mean_b));
  require(std::abs(metrics.mean_a - metrics.mean_b) <= tolerance.mean * larger_mean,
          fmt::format("The means {:.9g} and {:.9g} differ by more than {:g} relative.", metrics.mean_a, metrics.mean_b,
                      tolerance.mean));
  verdict.agree = verdict.reasons.empty();
  return verdict;
}

const char* name(const Verdict& verdict) { return verdict.agree ? "agree" : "differ"; }

}  // namespace tandem::compare
