#include "pathtracer/render/metropolis_picture.hpp"

#include <algorithm>
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
constexpr double splat_units = 1 << 24;
constexpr std::uint32_t workgroup_size = 64;

/// Beyond these segments, few paths still matter to a chain.
constexpr std::uint32_t most_stored_segments = 32;

/// So that no sum of splats overflows: each is below 2^8 times 2^24 units, and a sum has 64 bits.
constexpr std::uint64_t most_mutations = std::uint64_t{1} << 32;

/// Weights of splats are below (1 + brightness / scale) / the least weight of luminance, 14: with this, below 2^8.
constexpr double largest_brightness = 16;  // in units of the scale

/// MetropolisConstants of shaders/metropolis/chain.glsl.
struct MetropolisConstants {
  std::uint32_t chain_words = 0;
  std::uint32_t stored_segments = 0;
  float large_step = 0;
  float inverse_scale = 0;
  float normalisation = 0;
  std::uint32_t reserved[3] = {};
};
static_assert(sizeof(MetropolisConstants) == 32);

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

}  // namespace

MetropolisStart metropolis_start(std::span<const float> luminances, std::uint32_t chains, std::uint32_t seed) {
  const std::size_t half = luminances.size() / 2;
  const std::span<const float> seeds = luminances.subspan(half);
  const double total = sum(seeds);
  MetropolisStart start;
  start.brightness = total / static_cast<double>(seeds.size());
  // The bound is far from where any picture comes out well: it keeps splats within the room of their sums.
  start.scale =
      std::max(sum(luminances.first(half)) / static_cast<double>(half), start.brightness / largest_brightness);
  if (start.brightness == 0) return start;
  // Systematic: one random number, then equal steps through the sum.
  const double offset = uniform(seed);
  std::size_t path = 0;
  double reached = double{seeds[0]};
  for (std::uint32_t chain = 0; chain < chains; ++chain) {
    const double wanted = (chain + offset) / chains * total;
    while (reached <= wanted && path + 1 < seeds.size()) reached += double{seeds[++path]};
    // Rounding may leave the last steps beyond the sum.
    while (seeds[path] == 0) --path;
    start.paths.push_back(static_cast<std::uint32_t>(half + path));
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
  splats_ = buffer(6 * pixels, "splats");
  chains_ = buffer(std::uint64_t{metropolis.chains} * chain_words(stored_segments(settings)), "chains");
  bootstrap_ = buffer(metropolis.bootstrap_paths, "bootstrap paths");
  starts_ = buffer(metropolis.chains, "starts of chains");
  constants_ = buffer(sizeof(MetropolisConstants) / sizeof(std::uint32_t), "Metropolis constants");
  std::vector<rhi::BindGroupEntry> entries;
  for (const rhi::BufferHandle& bound : {ray_counts_, splats_, chains_, bootstrap_, starts_, constants_})
    entries.push_back({.binding = static_cast<std::uint32_t>(1 + entries.size()), .resource = rhi::BufferRange{bound}});
  group_ = scene.device().create_bind_group({.pipeline = scene.program(PathTraceTask::metropolis).pipeline(),
                                             .set = 1,
                                             .entries = entries,
                                             .label = "Metropolis"});
  const rhi::CommandListHandle list = scene.device().create_command_list("clear the chains");
  for (const rhi::BufferHandle& zero : {ray_counts_, splats_, chains_, bootstrap_, starts_}) list->fill({zero}, 0);
  scene.device().submit(list)->wait();
  upload_constants(scene, 1, 1);
}

void MetropolisPicture::upload_constants(SceneOnDevice& scene, double scale, double brightness) {
  const RenderSettings& settings = scene.settings();
  const std::uint32_t segments = stored_segments(settings);
  const MetropolisConstants constants{.chain_words = chain_words(segments),
                                      .stored_segments = segments,
                                      .large_step = settings.metropolis.large_step,
                                      .inverse_scale = static_cast<float>(1 / scale),
                                      .normalisation = static_cast<float>(brightness / scale)};
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
  if (start.brightness == 0) return true;
  scale_ = start.scale;
  upload_constants(scene, start.scale, start.brightness);
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
  const std::vector<std::uint64_t> sums = rhi::read<std::uint64_t>(scene.device(), splats_, 3 * pixels);
  const double factor = scale_ / splat_units / samples;
  const auto value = [&](std::size_t channel) {
    return static_cast<float>(static_cast<double>(sums[channel]) * factor);
  };
  for (std::size_t i = 0; i < pixels; ++i) image.pixels.emplace_back(value(3 * i), value(3 * i + 1), value(3 * i + 2));
  return image;
}

}  // namespace tandem::pathtracer
