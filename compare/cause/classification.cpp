#include "compare/cause/classification.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>
#include <span>
#include <utility>

#include "compare/cause/pixel_selection.hpp"
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

  void look_at(std::span<const SelectedPixel> pixels) {
    std::vector<PathStart> starts;
    for (const SelectedPixel& each : pixels)
      for (std::uint32_t sample = 0; sample < samples_; ++sample)
        starts.push_back({.path = {.pixel = each.pixel, .sample = sample}});
    const std::vector<PathSummary> a = pathtracer::summarize_paths(devices_.a, starts),
                                   b = pathtracer::summarize_paths(devices_.b, starts);
    result_.traced_paths += starts.size();

    std::vector<PathId> paths;
    for (std::size_t i = 0; i < starts.size(); ++i) {
      const bool differs = a[i] != b[i];
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
      for (ClassifiedPath& path : classify_paths(devices_, scene_, some)) {
        for (const Divergence& divergence : path.divergences)
          ++result_.divergence_counts[static_cast<std::size_t>(divergence.difference_class)];
        if (!path.divergences.empty()) result_.paths.push_back(std::move(path));
      }
    }
  }

  /// @param paths those of the batch
  void add_pixel(const SelectedPixel& selected, char wrong_sum, std::span<const ClassifiedPath> paths) {
    std::optional<DifferenceClass> worst;
    for (const ClassifiedPath& path : paths)
      if (path.path.pixel == selected.pixel) worst = std::max(worst, path.worst());
    if (wrong_sum != 0) worst = DifferenceClass::mismatch;
    if (selected.surveyed) ++result_.surveyed_pixels;
    if (selected.differs) {
      ++result_.classed_pixels;
      // A picture that differs while no path does would be the work of neither.
      if (!worst) worst = DifferenceClass::mismatch;
      ++result_.pixel_counts[static_cast<std::size_t>(*worst)];
    }
    if (selected.differs || worst == DifferenceClass::mismatch)
      result_.pixels.push_back({.pixel = selected.pixel, .difference_class = *worst, .wrong_sum = wrong_sum});
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
  const std::vector<SelectedPixel> pixels =
      select_pixels(differing, image_a.width, image_a.height, options.survey_pixels);
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

}  // namespace tandem::compare
