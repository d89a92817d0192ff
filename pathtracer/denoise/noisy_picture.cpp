#include "pathtracer/denoise/noisy_picture.hpp"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <limits>
#include <string_view>

#include <glm/geometric.hpp>

#include "base/error.hpp"
#include "pathtracer/render/first_hits.hpp"

namespace tandem::pathtracer {
namespace {

constexpr std::uint32_t most_batches = 16;

/// The mean and the spread of batches, pixel by pixel (West 1979: batches may differ in weight).
class BatchSpread {
 public:
  explicit BatchSpread(std::size_t pixels) : total_(pixels, glm::dvec3(0)), squares_(pixels, glm::dvec3(0)) {}

  /// @param mean of all samples so far @param samples that are new
  void add(const Image& mean, std::uint32_t samples) {
    const double before = samples_;
    samples_ += samples;
    ++batches_;
    for (std::size_t i = 0; i < total_.size(); ++i) {
      const glm::dvec3 total = glm::dvec3(mean.pixels[i]) * samples_;
      if (before > 0) {
        const glm::dvec3 difference = (total - total_[i]) / double(samples) - total_[i] / before;
        squares_[i] += difference * difference * (double(samples) * before / samples_);
      }
      total_[i] = total;
    }
  }

  std::vector<glm::vec3> variance_of_mean() const {
    std::vector<glm::vec3> result(total_.size(), glm::vec3(-1));
    if (batches_ < 2) return result;
    for (std::size_t i = 0; i < total_.size(); ++i)
      result[i] = glm::vec3(squares_[i] / (double(batches_ - 1) * samples_));
    return result;
  }

 private:
  std::vector<glm::dvec3> total_, squares_;
  double samples_ = 0;
  std::uint32_t batches_ = 0;
};

std::vector<float> plane(const std::vector<ImageChannel>& channels, std::string_view name) {
  const auto found = std::ranges::find(channels, name, &ImageChannel::name);
  if (found == channels.end()) throw Error("first hits have no such channel");
  std::vector<float> values;
  for (const std::uint32_t word : found->words) values.push_back(std::bit_cast<float>(word));
  return values;
}

std::vector<glm::vec3> planes(const std::vector<ImageChannel>& channels, const char* x, const char* y, const char* z) {
  const std::vector<float> first = plane(channels, x), second = plane(channels, y), third = plane(channels, z);
  std::vector<glm::vec3> values;
  for (std::size_t i = 0; i < first.size(); ++i) values.emplace_back(first[i], second[i], third[i]);
  return values;
}

}  // namespace

std::optional<NoisyPicture> render_noisy_picture(Renderer& renderer, std::uint32_t samples, const Progress& progress) {
  if (samples == 0) throw Error("a picture has at least one sample");
  if (renderer.samples() != 0) throw Error("a picture whose noise is measured begins empty");
  const RenderSettings& settings = renderer.scene().settings();
  const std::uint32_t batches = std::min(samples, most_batches);
  BatchSpread spread(std::size_t{settings.width} * settings.height);
  for (std::uint32_t batch = 0; batch < batches; ++batch) {
    const auto count = static_cast<std::uint32_t>(std::uint64_t{samples} * (batch + 1) / batches - renderer.samples());
    Progress part;
    if (progress) part = [&](double fraction) { return progress((batch + fraction) / batches); };
    if (!renderer.render(count, part)) return std::nullopt;
    spread.add(renderer.image(), count);
  }
  if (samples > std::numeric_limits<std::uint32_t>::max() / guide_samples_per_sample)
    throw Error("these are too many samples to denoise");
  const std::vector<ImageChannel> sampled = first_hits(renderer.scene(), samples);
  const std::vector<ImageChannel> hits = first_hits(renderer.scene(), guide_samples_per_sample * samples);
  return NoisyPicture{.radiance = renderer.image(),
                      .variance = spread.variance_of_mean(),
                      .sampled_albedo = planes(sampled, "albedo.R", "albedo.G", "albedo.B"),
                      .sampled_emission = planes(sampled, "emission.R", "emission.G", "emission.B"),
                      .albedo = planes(hits, "albedo.R", "albedo.G", "albedo.B"),
                      .emission = planes(hits, "emission.R", "emission.G", "emission.B"),
                      .normal = planes(hits, "normal.X", "normal.Y", "normal.Z"),
                      .depth = plane(hits, "depth.Z"),
                      .coverage = plane(hits, "coverage.Y")};
}

}  // namespace tandem::pathtracer
