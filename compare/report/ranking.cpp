#include "compare/report/ranking.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "compare/image/image_pair.hpp"

namespace tandem::compare {
namespace {

/// The larger, the sooner it is looked at.
int severity(const RankedPixel& pixel) {
  return pixel.difference_class ? static_cast<int>(*pixel.difference_class) : -1;
}

double largest_difference(const glm::vec3& a, const glm::vec3& b) {
  if (!is_finite(a) || !is_finite(b)) return std::numeric_limits<double>::infinity();
  double largest = 0;
  for (int channel = 0; channel < 3; ++channel)
    largest = std::max(largest, std::abs(double{a[channel]} - double{b[channel]}));
  return largest;
}

}  // namespace

Ranking rank_pixels(const pathtracer::Image& a, const pathtracer::Image& b, const Classification* classification,
                    std::size_t limit) {
  check_pair(a, b);
  std::unordered_map<std::size_t, DifferenceClass> classes;
  if (classification != nullptr) {
    for (const ClassifiedPixel& classified : classification->pixels)
      classes[std::size_t{classified.pixel.y} * a.width + classified.pixel.x] = classified.difference_class;
  }
  Ranking ranking;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    const bool differs = !is_bit_equal(a.pixels[i], b.pixels[i]);
    const auto found = classes.find(i);
    if (differs) ++ranking.differing_pixels;
    if (!differs && found == classes.end()) continue;
    RankedPixel pixel{.pixel = {i % a.width, i / a.width},
                      .difference_class = {},
                      .difference = differs ? largest_difference(a.pixels[i], b.pixels[i]) : 0};
    if (found != classes.end()) pixel.difference_class = found->second;
    ranking.pixels.push_back(pixel);
  }
  std::ranges::stable_sort(ranking.pixels, [](const RankedPixel& first, const RankedPixel& second) {
    const int of_first = severity(first), of_second = severity(second);
    return of_first != of_second ? of_first > of_second : first.difference > second.difference;
  });
  if (ranking.pixels.size() > limit) ranking.pixels.resize(limit);
  return ranking;
}

std::vector<RankedPixel> pixels_to_record(const Ranking& ranking, std::size_t count) {
  const std::vector<RankedPixel>& all = ranking.pixels;
  if (all.size() <= count) return all;
  const int worst = severity(all.front());
  const auto of_worst = static_cast<std::size_t>(
      std::ranges::count_if(all, [worst](const RankedPixel& pixel) { return severity(pixel) == worst; }));
  const std::size_t first = std::min(of_worst, (count + 1) / 2);
  std::vector<RankedPixel> result(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(first));
  const std::size_t rest = count - first;
  for (std::size_t i = 0; i < rest; ++i) result.push_back(all[first + i * (all.size() - first) / rest]);
  return result;
}

}  // namespace tandem::compare
