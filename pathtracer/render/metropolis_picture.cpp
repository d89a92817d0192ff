#include "pathtracer/render/metropolis_picture.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <limits>

#include <fmt/format.h>

#include "base/error.hpp"
#include "rhi/transfer.hpp"

namespace tandem::pathtracer {
namespace {

// Of shaders/metropolis.
constexpr std::uint32_t stage_bootstrap = 0;
constexpr std::uint32_t stage_start = 1;
constexpr std::uint32_t stage_mutate = 2;
constexpr std::uint32_t chain_header = 9;
constexpr std::uint32_t slot_words = 10;
constexpr double splat_units = 1 << 28;
constexpr std::uint32_t workgroup_size = 16;  // few: a device may have more processors than that many chains fill

/// Beyond these segments, few paths still matter to a chain.
constexpr std::uint32_t most_stored_segments = 32;

/// So that no sum of splats overflows: each is below 2^32 units, and a sum has 64 bits.
constexpr std::uint64_t most_mutations = std::uint64_t{1} << 32;

/// MetropolisConstants of shaders/metropolis/chain.glsl.
struct MetropolisConstants {
  std::uint32_t chain_words = 0;
  std::uint32_t stored_segments = 0;
  float large_step = 0;
  float inverse_scale = 0;
};

/// LargeSteps of the same file.
struct LargeSteps {
  float sum;
  float lost;
  std::uint32_t count;
  std::uint32_t reserved;
};

/// The camera and two dimensions for each segment, the time, and media: slot_of of the shader.
std::uint32_t chain_words(std::uint32_t segments) { return chain_header + slot_words * (2 + 3 * segments); }

std::uint32_t stored_segments(const RenderSettings& settings) {
  return std::min(settings.max_depth, most_stored_segments);
}

/// In [0, 1): one number of a seed, by the last steps of MurmurHash3 (Appleby 2011).
double uniform(std::uint32_t seed) {
  std::uint32_t hash = seed ^ 0x27d4eb2fu;
  hash = (hash ^ hash >> 16) * 0x85ebca6bu;
  hash = (hash ^ hash >> 13) * 0xc2b2ae35u;
  return (hash ^ hash >> 16) / 4294967296.0;
}

double sum(std::span<const float> values) {
  double result = 0;
  for (const float value : values) result += double{value};
  return result;
}

/// Indices into `weights`, each in proportion to its weight: systematic resampling, one random number and then equal
/// steps through the sum. @param offset in [0, 1)
std::vector<std::uint32_t> resampled(std::span<const float> weights, std::uint32_t count, double offset) {
  const double total = sum(weights);
  std::vector<std::uint32_t> result;
  std::size_t index = 0;
  double reached = double{weights[0]};
  for (std::uint32_t i = 0; i < count; ++i) {
    const double wanted = (i + offset) / count * total;
    while (reached <= wanted && index + 1 < weights.size()) reached += double{weights[++index]};
    // Rounding may leave the last steps beyond the sum.
    while (weights[index] == 0) --index;
    result.push_back(static_cast<std::uint32_t>(index));
  }
  return result;
}

}  // namespace

MetropolisStart metropolis_start(std::span<const float> luminances, std::uint32_t chains, std::uint32_t seed) {
  const std::size_t quarter = luminances.size() / 4;
  MetropolisStart start;
  start.scale = sum(luminances.first(2 * quarter)) / static_cast<double>(2 * quarter);
  for (std::size_t group = 0; group < 2; ++group)
    start.brightness[group] = sum(luminances.subspan((2 + group) * quarter, quarter)) / static_cast<double>(quarter);
  const double both = (start.brightness[0] + start.brightness[1]) / 2;
  if (both == 0) return start;
  if (start.scale == 0) start.scale = both;
  // Where a quarter has no light, the other has to do for both groups.
  const bool shared = start.brightness[0] == 0 || start.brightness[1] == 0;
  if (shared) start.brightness = {both, both};
  start.paths.resize(chains);
  for (std::uint32_t group = 0; group < 2; ++group) {
    const std::size_t first = (shared ? 2 : 2 + group) * quarter;
    const std::vector<std::uint32_t> chosen =
        resampled(luminances.subspan(first, shared ? 2 * quarter : quarter), chains / 2, uniform(seed + group));
    for (std::size_t i = 0; i < chosen.size(); ++i)
      start.paths[2 * i + group] = static_cast<std::uint32_t>(first + chosen[i]);
  }
  return start;
}

void MetropolisPicture::prepare(SceneOnDevice& scene) {
  if (group_) return;
  const RenderSettings& settings = scene.settings();
  const MetropolisSettings& metropolis = settings.metropolis;
  const std::uint64_t pixels = std::uint64_t{settings.width} * settings.height;
  const auto buffer = [&](std::uint64_t words, const char* label) {
    return scene.device().create_buffer(
        {.size = words * sizeof(std::uint32_t), .usage = rhi::BufferUsage::storage, .label = label});
  };
  ray_counts_ = buffer(std::max(metropolis.bootstrap_paths, metropolis.chains), "ray counts");
  splats_ = buffer(12 * pixels, "splats");
  chains_ = buffer(std::uint64_t{metropolis.chains} * chain_words(stored_segments(settings)), "chains");
  bootstrap_ = buffer(metropolis.bootstrap_paths, "bootstrap paths");
  starts_ = buffer(metropolis.chains, "starts of chains");
  constants_ = buffer(sizeof(MetropolisConstants) / sizeof(std::uint32_t), "Metropolis constants");
  std::vector<rhi::BindGroupEntry> entries;
  large_splats_ = buffer(6 * pixels, "splats of large steps");
  large_steps_ = buffer(std::uint64_t{metropolis.chains} * sizeof(LargeSteps) / sizeof(std::uint32_t), "large steps");
  for (const rhi::BufferHandle& bound :
       {ray_counts_, splats_, chains_, bootstrap_, starts_, constants_, large_splats_, large_steps_})
    entries.push_back({.binding = static_cast<std::uint32_t>(1 + entries.size()), .resource = rhi::BufferRange{bound}});
  group_ = scene.device().create_bind_group({.pipeline = scene.program(PathTraceTask::metropolis).pipeline(),
                                             .set = 1,
                                             .entries = entries,
                                             .label = "Metropolis"});
  const rhi::CommandListHandle list = scene.device().create_command_list("clear the chains");
  for (const rhi::BufferHandle& zero :
       {ray_counts_, splats_, chains_, bootstrap_, starts_, large_splats_, large_steps_})
    list->fill({zero}, 0);
  scene.device().submit(list)->wait();
  upload_constants(scene, 1);
}

void MetropolisPicture::upload_constants(SceneOnDevice& scene, double scale) {
  const RenderSettings& settings = scene.settings();
  const std::uint32_t segments = stored_segments(settings);
  const MetropolisConstants constants{.chain_words = chain_words(segments),
                                      .stored_segments = segments,
                                      .large_step = settings.metropolis.large_step,
                                      .inverse_scale = static_cast<float>(1 / scale)};
  const rhi::CommandListHandle list = scene.device().create_command_list("Metropolis constants");
  list->upload(constants_, 0, std::as_bytes(std::span(&constants, 1)));
  scene.device().submit(list)->wait();
}

void MetropolisPicture::warm_up(SceneOnDevice& scene) {
  prepare(scene);
  Pace pace(1);
  // A bootstrap path of no steps has no light, as the buffer says already.
  dispatch(scene, stage_bootstrap, {0, 1}, 0, 0, pace);
  device_milliseconds_ = 0;
}

void MetropolisPicture::dispatch(SceneOnDevice& scene, std::uint32_t stage, const Range& range,
                                 std::uint32_t first_step, std::uint32_t steps, Pace& pace) {
  const DispatchConstants constants{.tile_offset = {range.first, stage},
                                    .tile_size = {range.count, 1},
                                    .first_sample = first_step,
                                    .sample_count = steps};
  const auto start = std::chrono::steady_clock::now();
  device_milliseconds_ += scene.execute("Metropolis", [&](rhi::CommandList& list) {
    scene.program(PathTraceTask::metropolis)
        .record(list, {scene.bind_group(PathTraceTask::metropolis), group_}, constants);
  });
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  pace.measured(double(range.count) * steps, elapsed.count());
}

namespace {

/// Invocations from `first` on that take about the time of a submission, at most until `end`.
std::uint32_t next_count(std::uint32_t first, std::uint32_t end, double budget) {
  const double groups = std::max(1.0, budget / workgroup_size);
  if (groups * workgroup_size >= double(end - first)) return end - first;
  return static_cast<std::uint32_t>(groups) * workgroup_size;
}

}  // namespace

bool MetropolisPicture::bootstrap(SceneOnDevice& scene, Pace& pace, const Progress& progress) {
  const std::uint32_t count = scene.settings().metropolis.bootstrap_paths;
  for (std::uint32_t first = 0; first < count;) {
    const std::uint32_t some = next_count(first, count, pace.budget());
    dispatch(scene, stage_bootstrap, {first, some}, 0, 1, pace);
    first += some;
    if (progress && !progress(0)) return false;
  }
  const std::vector<float> luminances = rhi::read<float>(scene.device(), bootstrap_, count);
  const MetropolisStart start = metropolis_start(luminances, scene.settings().metropolis.chains, scene.settings().seed);
  has_started_ = true;
  if (start.paths.empty()) return true;
  scale_ = start.scale;
  brightness_ = start.brightness;
  upload_constants(scene, start.scale);
  const rhi::CommandListHandle list = scene.device().create_command_list("starts of chains");
  list->upload(starts_, 0, std::as_bytes(std::span(start.paths)));
  scene.device().submit(list)->wait();
  const auto chains = static_cast<std::uint32_t>(start.paths.size());
  for (std::uint32_t first = 0; first < chains;) {
    const std::uint32_t some = next_count(first, chains, pace.budget());
    dispatch(scene, stage_start, {first, some}, 0, 1, pace);
    first += some;
  }
  return true;
}

bool MetropolisPicture::render(SceneOnDevice& scene, std::uint32_t samples, Pace& pace, const Progress& progress) {
  const RenderSettings& settings = scene.settings();
  const std::uint32_t chains = settings.metropolis.chains;
  const std::uint64_t end = std::uint64_t{settings.width} * settings.height * samples;
  if (end > most_mutations)
    throw Error(fmt::format("{} samples of {}x{} pixels are more than the {} mutations that a Metropolis picture has",
                            samples, settings.width, settings.height, most_mutations));
  prepare(scene);
  if (!has_started_ && !bootstrap(scene, pace, progress)) return false;
  if (scale_ == 0) mutations_ = end;
  const std::uint64_t begin = mutations_;
  const auto cancelled = [&](std::uint64_t done) {
    return progress && !progress(double(done - begin) / double(end - begin));
  };
  while (mutations_ < end) {
    const auto step = static_cast<std::uint32_t>(mutations_ / chains);
    const auto first = static_cast<std::uint32_t>(mutations_ % chains);
    const std::uint64_t left = end - mutations_;
    // Rows of one mutation of each chain; what is not a whole row is one by itself.
    const bool whole = first == 0 && left >= chains;
    const auto last = static_cast<std::uint32_t>(whole ? chains : std::min<std::uint64_t>(chains, first + left));
    const auto steps =
        whole ? static_cast<std::uint32_t>(std::clamp(pace.budget() / chains, 1.0, double(left / chains))) : 1u;
    for (std::uint32_t chain = first; chain < last;) {
      const std::uint32_t some = next_count(chain, last, pace.budget() / steps);
      dispatch(scene, stage_mutate, {chain, some}, step + 1, steps, pace);
      chain += some;
      if (cancelled(mutations_ + std::uint64_t{chain - first} * steps)) return false;
    }
    mutations_ += std::uint64_t{last - first} * steps;
  }
  collect_ray_counts(scene);
  return true;
}

void MetropolisPicture::collect_ray_counts(SceneOnDevice& scene) {
  for (const std::uint32_t count :
       rhi::read<std::uint32_t>(scene.device(), ray_counts_, ray_counts_->size() / sizeof(std::uint32_t)))
    ray_count_ += count;
  const rhi::CommandListHandle list = scene.device().create_command_list("clear the ray counts");
  list->fill({ray_counts_}, 0);
  scene.device().submit(list)->wait();
}

Image MetropolisPicture::image(const SceneOnDevice& scene, std::uint32_t samples) const {
  const RenderSettings& settings = scene.settings();
  Image image{settings.width, settings.height, {}};
  const std::size_t pixels = std::size_t{image.width} * image.height;
  rhi::Device& device = scene.device();
  const std::vector<std::uint64_t> sums = rhi::read<std::uint64_t>(device, splats_, 6 * pixels);
  const std::vector<std::uint64_t> large = rhi::read<std::uint64_t>(device, large_splats_, 3 * pixels);
  // What each group has found out about the brightness, by bootstrap paths and large steps.
  const double bootstrap_paths = settings.metropolis.bootstrap_paths / 4;
  std::array<double, 2> luminance = {brightness_[0] * bootstrap_paths, brightness_[1] * bootstrap_paths};
  std::array<double, 2> paths = {bootstrap_paths, bootstrap_paths};
  const std::vector<LargeSteps> large_steps = rhi::read<LargeSteps>(device, large_steps_, settings.metropolis.chains);
  for (std::size_t chain = 0; chain < large_steps.size(); ++chain) {
    luminance[chain % 2] += double{large_steps[chain].sum} + double{large_steps[chain].lost};
    paths[chain % 2] += large_steps[chain].count;
  }
  std::array<double, 2> factors{};
  for (std::size_t group = 0; group < 2; ++group) {
    const std::size_t other = 1 - group;
    const double known = luminance[other] / paths[other] + brightness_[group] - brightness_[other];
    // One mutation is no pair: the other group has nothing to show.
    const double share = mutations_ < 2 ? 1 : 0.5;
    const double group_mutations = static_cast<double>(std::max<std::uint64_t>((mutations_ + other) / 2, 1));
    factors[group] = share * known / splat_units * static_cast<double>(pixels) / group_mutations;
  }
  const double large_factor = scale_ / splat_units / samples;
  const auto value = [&](std::size_t channel) {
    return static_cast<float>(static_cast<double>(sums[channel]) * factors[0] +
                              static_cast<double>(sums[3 * pixels + channel]) * factors[1] +
                              static_cast<double>(large[channel]) * large_factor);
  };
  for (std::size_t i = 0; i < pixels; ++i) image.pixels.emplace_back(value(3 * i), value(3 * i + 1), value(3 * i + 2));
  return image;
}

}  // namespace tandem::pathtracer
