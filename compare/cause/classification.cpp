#include "compare/cause/classification.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>
#include <random>
#include <utility>

#include "compare/cause/path_classifier.hpp"
#include "compare/image/difference.hpp"
#include "pathtracer/render/device_scene.hpp"
#include "pathtracer/render/path_recorder.hpp"

namespace tandem::compare {
namespace {

using pathtracer::Image;
using pathtracer::PathId;
using pathtracer::PathStart;
using pathtracer::PathSummary;

/// Paths that are looked at together: few at first, since a device that is all wrong is found out by them; then more,
/// since each turn costs something by itself.
constexpr std::size_t first_batch = 512;
constexpr std::size_t largest_batch = 1u << 15;

/// Paths whose recordings are in memory at once.
constexpr std::size_t paths_at_once = 2048;

struct Candidate {
  glm::uvec2 pixel{0};
  bool differs = false;
  bool surveyed = false;
};

std::uint64_t row_order(const glm::uvec2& pixel) { return (std::uint64_t{pixel.y} << 32u) + pixel.x; }

/// About `count` pixels, one at a random place in each cell of a grid; all of them when they are no more than that.
std::vector<glm::uvec2> spread_pixels(std::uint32_t width, std::uint32_t height, std::size_t count) {
  std::vector<glm::uvec2> pixels;
  if (count == 0) return pixels;
  const double cells = std::min(static_cast<double>(count), static_cast<double>(width) * height);
  const double aspect = static_cast<double>(width) / height;
  const std::uint32_t columns =
      std::clamp(static_cast<std::uint32_t>(std::lround(std::sqrt(cells * aspect))), 1u, width);
  const std::uint32_t rows = std::clamp(static_cast<std::uint32_t>(std::lround(cells / columns)), 1u, height);
  std::mt19937 random(1);
  const auto place = [&](std::uint32_t cell, std::uint32_t cell_count, std::uint32_t size) {
    const auto begin = static_cast<std::uint32_t>(std::uint64_t{cell} * size / cell_count);
    const auto end = static_cast<std::uint32_t>((std::uint64_t{cell} + 1) * size / cell_count);
    return begin + static_cast<std::uint32_t>(random()) % (end - begin);
  };
  for (std::uint32_t row = 0; row < rows; ++row)
    for (std::uint32_t column = 0; column < columns; ++column) {
      const std::uint32_t x = place(column, columns, width);
      pixels.emplace_back(x, place(row, rows, height));
    }
  return pixels;
}

/// What is to be looked at, in an order that spreads evenly over the picture from the beginning on.
std::vector<Candidate> candidates(std::span<const glm::uvec2> differing, std::span<const glm::uvec2> surveyed) {
  std::vector<Candidate> all;
  for (const glm::uvec2& pixel : differing) all.push_back({.pixel = pixel, .differs = true});
  for (const glm::uvec2& pixel : surveyed) all.push_back({.pixel = pixel, .surveyed = true});
  std::stable_sort(all.begin(), all.end(), [](const Candidate& first, const Candidate& second) {
    return row_order(first.pixel) < row_order(second.pixel);
  });
  std::vector<Candidate> merged;
  for (const Candidate& each : all) {
    if (merged.empty() || merged.back().pixel != each.pixel) {
      merged.push_back(each);
    } else {
      merged.back().differs |= each.differs;
      merged.back().surveyed |= each.surveyed;
    }
  }
  std::mt19937 random(2);
  for (std::size_t i = merged.size(); i > 1; --i) std::swap(merged[i - 1], merged[random() % i]);
  return merged;
}

/// Whether a pixel is the mean of its paths, bit by bit, as Renderer::image takes it.
bool is_sum(const Image& image, const glm::uvec2& pixel, std::span<const PathSummary> paths) {
  glm::vec3 sum(0);
  for (const PathSummary& path : paths) sum += path.radiance;
  const glm::vec3 mean = sum / static_cast<float>(paths.size());
  const glm::vec3& value = image.at(pixel.x, pixel.y);
  for (int i = 0; i < 3; ++i) {
    const bool both_nan = std::isnan(mean[i]) && std::isnan(value[i]);
    if (!both_nan && std::memcmp(&mean[i], &value[i], sizeof(float)) != 0) return false;
  }
  return true;
}

class Classifier {
 public:
  Classifier(const Devices& devices, const Image& image_a, const Image& image_b, std::uint32_t samples)
      : devices_(devices),
        scene_(pathtracer::in_device_order(devices.scene)),
        image_a_(image_a),
        image_b_(image_b),
        samples_(samples) {}

  void look_at(std::span<const Candidate> pixels) {
    std::vector<PathStart> starts;
    for (const Candidate& each : pixels)
      for (std::uint32_t sample = 0; sample < samples_; ++sample)
        starts.push_back({.path = {.pixel = each.pixel, .sample = sample}});
    const std::vector<PathSummary> a = pathtracer::summarize_paths(devices_.a, starts), b = pathtracer::summarize_paths(devices_.b, starts);
    result_.traced_paths += starts.size();

    std::vector<PathId> paths;
    for (std::size_t i = 0; i < starts.size(); ++i) {
      const bool differs = !is_same(a[i], b[i]);
      result_.differing_paths += differs ? 1 : 0;
      if (differs || (pixels[i / samples_].surveyed && i % samples_ == 0)) paths.push_back(starts[i].path);
    }
    const std::size_t known = result_.paths.size();
    record(paths);
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      const auto summaries = [&](const std::vector<PathSummary>& all) {
        return std::span(all).subspan(i * samples_, samples_);
      };
      const char wrong_sum = !is_sum(image_a_, pixels[i].pixel, summaries(a))   ? 'a'
                             : !is_sum(image_b_, pixels[i].pixel, summaries(b)) ? 'b'
                                                                                : char{0};
      add_pixel(pixels[i], wrong_sum, std::span(result_.paths).subspan(known));
    }
  }

  const Classification& result() const { return result_; }
  std::size_t recorded_paths() const { return recorded_paths_; }

  Classification finish() && {
    const auto by_path = [](const ClassifiedPath& first, const ClassifiedPath& second) {
      const std::uint64_t a = row_order(first.path.pixel), b = row_order(second.path.pixel);
      return a != b ? a < b : first.path.sample < second.path.sample;
    };
    std::sort(result_.paths.begin(), result_.paths.end(), by_path);
    std::sort(result_.pixels.begin(), result_.pixels.end(), [](const ClassifiedPixel& a, const ClassifiedPixel& b) {
      return row_order(a.pixel) < row_order(b.pixel);
    });
    return std::move(result_);
  }

 private:
  void record(std::span<const PathId> paths) {
    recorded_paths_ += paths.size();
    for (std::size_t first = 0; first < paths.size(); first += paths_at_once) {
      const auto some = paths.subspan(first, std::min(paths_at_once, paths.size() - first));
      for (ClassifiedPath& path : judge_paths(devices_, scene_, some)) {
        for (const Divergence& divergence : path.divergences)
          ++result_.divergence_counts[static_cast<std::size_t>(divergence.difference_class)];
        if (!path.divergences.empty()) result_.paths.push_back(std::move(path));
      }
    }
  }

  /// @param paths those of the batch
  void add_pixel(const Candidate& candidate, char wrong_sum, std::span<const ClassifiedPath> paths) {
    std::optional<DifferenceClass> worst;
    for (const ClassifiedPath& path : paths)
      if (path.path.pixel == candidate.pixel) worst = std::max(worst, path.worst());
    if (wrong_sum != 0) worst = DifferenceClass::mismatch;
    if (candidate.surveyed) ++result_.surveyed_pixels;
    if (candidate.differs) {
      ++result_.classed_pixels;
      // A picture that differs while no path does would be the work of neither.
      if (!worst) worst = DifferenceClass::mismatch;
      ++result_.pixel_counts[static_cast<std::size_t>(*worst)];
    }
    if (candidate.differs || worst == DifferenceClass::mismatch)
      result_.pixels.push_back({.pixel = candidate.pixel, .difference_class = *worst, .wrong_sum = wrong_sum});
  }

  Devices devices_;
  pathtracer::Scene scene_;
  const Image& image_a_;
  const Image& image_b_;
  std::uint32_t samples_;
  std::size_t recorded_paths_ = 0;
  Classification result_;
};

}  // namespace

std::optional<DifferenceClass> ClassifiedPath::worst() const {
  std::optional<DifferenceClass> worst;
  for (const Divergence& divergence : divergences) worst = std::max(worst, std::optional(divergence.difference_class));
  return worst;
}

std::uint64_t Classification::mismatches() const {
  const auto wrong_paths = std::ranges::count_if(
      paths, [](const ClassifiedPath& path) { return path.worst() == DifferenceClass::mismatch; });
  const auto wrong_sums =
      std::ranges::count_if(pixels, [](const ClassifiedPixel& pixel) { return pixel.wrong_sum != 0; });
  return static_cast<std::uint64_t>(wrong_paths + wrong_sums);
}

Classification classify(Devices devices, const Image& image_a, const Image& image_b, std::uint32_t samples,
                        const ClassificationOptions& options, const Progress& progress) {
  std::uint64_t differing_count = 0;
  const std::vector<glm::uvec2> differing = differing_pixels(image_a, image_b, options.pixel_limit, differing_count);
  const std::vector<Candidate> pixels =
      candidates(differing, spread_pixels(image_a.width, image_a.height, options.survey_pixels));
  Classifier classifier(devices, image_a, image_b, samples);
  std::size_t batch = first_batch;
  for (std::size_t first = 0; samples > 0 && first < pixels.size();) {
    if (progress && !progress(static_cast<double>(first) / static_cast<double>(pixels.size()))) break;
    if (classifier.recorded_paths() >= options.path_limit || classifier.result().mismatches() >= options.mismatch_limit)
      break;
    const std::size_t count = std::clamp<std::size_t>(batch / samples, 1, pixels.size() - first);
    classifier.look_at(std::span(pixels).subspan(first, count));
    first += count;
    batch = std::min(2 * batch, largest_batch);
  }
  Classification result = std::move(classifier).finish();
  result.differing_pixels = differing_count;
  return result;
}

std::vector<ClassifiedPath> classify_paths(Devices devices, std::span<const PathId> paths) {
  return judge_paths(devices, pathtracer::in_device_order(devices.scene), paths);
}

}  // namespace tandem::compare
