#include "compare/statistics/bias_test.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/error.hpp"
#include "base/statistics/distributions.hpp"
#include "base/statistics/power.hpp"

namespace tandem::compare {

using namespace statistics;
namespace {

/// Of tests for tiles and tests for the picture: two families, each corrected for itself first.
constexpr std::size_t families = 2;

Tile whole(const BatchedEstimate& estimate) {
  const Tile& last = estimate.tiles().back();
  return {.left = 0, .top = 0, .width = last.left + last.width, .height = last.top + last.height};
}

void check_alike(const BatchedEstimate& a, const BatchedEstimate& b) {
  const auto same = [](const Tile& s, const Tile& t) { return s.width == t.width && s.height == t.height; };
  if (a.tiles().size() != b.tiles().size() || a.tiles().empty() || !same(whole(a), whole(b)) ||
      !same(a.tiles().front(), b.tiles().front()))
    throw Error("estimates of different sizes or tiles cannot be compared");
}

double pixels(const Tile& tile) { return static_cast<double>(tile.width) * tile.height; }

/// How much darker chance may make a tile is not seen in its own noise where the rare events that light it have not
/// happened. So the error of each tile is enlarged by that of so many further events of the size usual in the picture.
/// With 20, light paths that find the light by chance failed no more often than the p-value says; in ordinary pictures,
/// whose tiles gather thousands of events, it changes nothing (docs/guide/statistics.md).
constexpr double further_events = 20;

/// How much one event adds to the sum over the pixels of a tile: a sum of N events of one size, N with a Poisson
/// distribution, has a variance of its mean times that size. Of the median tile that has noise.
double usual_event(const BatchedEstimate& estimate, Channel channel) {
  std::vector<double> events;
  for (std::size_t i = 0; i < estimate.tiles().size(); ++i) {
    const Mean mean = estimate.tile_mean(i, channel);
    if (mean.value > 0 && mean.standard_error > 0)
      events.push_back(mean.standard_error * mean.standard_error / mean.value * pixels(estimate.tiles()[i]));
  }
  if (events.empty()) return 0;
  const auto median = events.begin() + static_cast<std::ptrdiff_t>(events.size() / 2);
  std::ranges::nth_element(events, median);
  return *median;
}

/// Means over tiles in one channel, with errors that events which have not happened are allowed for.
class TileMeans {
 public:
  TileMeans(const BatchedEstimate& estimate, Channel channel)
      : estimate_(estimate), channel_(channel), event_(usual_event(estimate, channel)) {}

  Mean operator[](std::size_t tile) const {
    Mean mean = estimate_.tile_mean(tile, channel_);
    mean.standard_error =
        std::hypot(mean.standard_error, std::sqrt(further_events) * event_ / pixels(estimate_.tiles()[tile]));
    return mean;
  }

 private:
  const BatchedEstimate& estimate_;
  Channel channel_;
  double event_;
};

ComparedMean compared(const Tile& tile, Channel channel, const Mean& a, const Mean& b) {
  return {.tile = tile, .channel = channel, .a = a, .b = b, .p_value = welch_p_value(a, b)};
}

double root_mean_square_difference(const pathtracer::Image& a, const pathtracer::Image& b) {
  double sum = 0;
  double count = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    const glm::dvec3 difference = glm::dvec3(a.pixels[i]) - glm::dvec3(b.pixels[i]);
    const double square = difference.x * difference.x + difference.y * difference.y + difference.z * difference.z;
    if (!std::isfinite(square)) continue;
    sum += square;
    count += 3;
  }
  return count > 0 ? std::sqrt(sum / count) : 0.0;
}

/// The smallest bias of a mean, relative to that of `a`, that a test of its own at level `p_value` finds.
double detectable_bias(const Mean& a, const Mean& b, double p_value, double probability) {
  const DifferenceError error = difference_error(a, b);
  if (error.freedom == 0 || a.value == 0) return 0;
  const double critical = student_critical_value(p_value, error.freedom);
  return detectable_shift(probability, critical, error.freedom) * error.standard_error / std::abs(a.value);
}

}  // namespace

double ComparedMean::relative_difference() const { return a.value == 0 ? 0.0 : (b.value - a.value) / a.value; }

BiasTest test_bias(const BatchedEstimate& a, const BatchedEstimate& b) {
  check_alike(a, b);
  BiasTest test;
  const auto keep_worse = [](ComparedMean& worst, const ComparedMean& mean, bool first) {
    if (first || mean.p_value < worst.p_value) worst = mean;
  };
  for (const Channel channel : channels) {
    const TileMeans means_a(a, channel);
    const TileMeans means_b(b, channel);
    for (std::size_t i = 0; i < a.tiles().size(); ++i)
      keep_worse(test.worst_tile, compared(a.tiles()[i], channel, means_a[i], means_b[i]), test.tile_tests++ == 0);
  }
  for (const Channel channel : channels)
    keep_worse(test.worst_mean, compared(whole(a), channel, a.picture_mean(channel), b.picture_mean(channel)),
               channel == channels.front());
  test.tiles_p_value = sidak(test.worst_tile.p_value, test.tile_tests);
  test.picture_p_value = sidak(test.worst_mean.p_value, channels.size());
  test.p_value = sidak(std::min(test.tiles_p_value, test.picture_p_value), families);
  test.rmse = root_mean_square_difference(a.image(), b.image());
  return test;
}

BiasPower bias_power(const BatchedEstimate& a, const BatchedEstimate& b, double level, double probability) {
  check_alike(a, b);
  const double family = sidak_single(level, families);
  BiasPower power{.level = level, .probability = probability, .picture = 0, .median_tile = 0, .tile = {}};
  const TileMeans means_a(a, Channel::luminance);
  const TileMeans means_b(b, Channel::luminance);
  power.picture = detectable_bias(a.picture_mean(Channel::luminance), b.picture_mean(Channel::luminance),
                                  sidak_single(family, channels.size()), probability);
  struct Noise {
    std::size_t tile;
    double relative_error;
  };
  std::vector<Noise> noises;
  for (std::size_t i = 0; i < a.tiles().size(); ++i) {
    const Mean mean_a = means_a[i];
    const DifferenceError error = difference_error(mean_a, means_b[i]);
    if (error.freedom > 0 && mean_a.value > 0)
      noises.push_back({.tile = i, .relative_error = error.standard_error / mean_a.value});
  }
  if (noises.empty()) return power;
  const auto median = noises.begin() + static_cast<std::ptrdiff_t>(noises.size() / 2);
  std::ranges::nth_element(noises, median, {}, &Noise::relative_error);
  power.tile = a.tiles()[median->tile];
  power.median_tile = detectable_bias(means_a[median->tile], means_b[median->tile],
                                      sidak_single(family, a.tiles().size() * channels.size()), probability);
  return power;
}

}  // namespace tandem::compare
