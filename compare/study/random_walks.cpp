#include "compare/study/random_walks.hpp"

#include <chrono>
#include <span>
#include <utility>

#include <glm/vec2.hpp>

#include "rhi/transfer.hpp"
#include "study_shaders/spirv.hpp"

namespace tandem::study {
namespace {

/// Few enough for their sums to be exact to a float's last digits, many enough to keep an invocation busy.
constexpr std::uint32_t block_size = 64;

/// Of walks that are absorbed: by then less than 1e-19 of the series is left, since norms are at most 1/2.
constexpr std::uint32_t absorbed_length_limit = 64;

/// WalkConstants of shaders/study/random_walk.comp.
struct WalkConstants {
  FredholmKernel equation;
  WalkEstimator estimator;
  std::uint32_t point_count;
  std::uint32_t block_count;
  std::uint32_t block_size;
  std::uint32_t first_walk;
  std::uint32_t length_limit;
  float absorption;
  std::uint32_t seed;
};

}  // namespace

std::vector<std::string> walk_estimator_names() {
  return {"fixed length", "absorption", "collision", "expected value"};
}

RandomWalks::RandomWalks(rhi::DeviceHandle device) : device_(std::move(device)) {
  pipeline_ = device_->create_compute_pipeline(
      {.shader = device_->create_shader_module({study_shaders::random_walk(), "random_walk.comp", true}),
       .specialization = {},
       .label = "random walks"});
  if (device_->info().capabilities.timestamps)
    timestamps_ = device_->create_query_pool({.count = 2, .label = "random walks"});
}

WalkEstimates RandomWalks::run(FredholmKernel kernel, WalkEstimator estimator, const WalkSettings& settings,
                               std::uint32_t first_walk, std::uint32_t walks) {
  const bool is_absorbed = estimator != WalkEstimator::fixed_length;
  const std::uint32_t blocks = walks / block_size;
  const WalkConstants constants{.equation = kernel,
                                .estimator = estimator,
                                .point_count = settings.points,
                                .block_count = blocks,
                                .block_size = block_size,
                                .first_walk = first_walk,
                                .length_limit = is_absorbed ? absorbed_length_limit : settings.length,
                                .absorption = is_absorbed ? static_cast<float>(settings.absorption) : 0.0f,
                                .seed = settings.seed};
  const std::uint32_t invocations = settings.points * blocks;
  const rhi::BufferHandle buffer = device_->create_buffer(
      {.size = invocations * sizeof(glm::vec2), .usage = rhi::BufferUsage::storage, .label = "sums of walks"});
  const std::vector<rhi::BindGroupEntry> entries = {{.binding = 0, .resource = rhi::BufferRange{buffer}}};
  const rhi::BindGroupHandle group =
      device_->create_bind_group({.pipeline = pipeline_, .set = 0, .entries = entries, .label = "random walks"});
  const rhi::CommandListHandle list = device_->create_command_list("random walks");
  if (timestamps_) list->write_timestamp(timestamps_, 0);
  const std::uint32_t workgroup = pipeline_->reflection().workgroup_size[0];
  list->dispatch({.pipeline = pipeline_,
                  .bind_groups = {group},
                  .push_constants = std::as_bytes(std::span(&constants, 1)),
                  .workgroup_count = {(invocations + workgroup - 1) / workgroup, 1, 1}});
  if (timestamps_) list->write_timestamp(timestamps_, 1);
  const auto start = std::chrono::steady_clock::now();
  device_->submit(list)->wait();
  WalkEstimates estimates;
  estimates.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (timestamps_) {
    const std::vector<double> times = timestamps_->timestamps_ns();
    estimates.seconds = (times[1] - times[0]) * 1e-9;
  }
  const std::vector<glm::vec2> sums = rhi::read<glm::vec2>(*device_, buffer, invocations);
  for (std::uint32_t point = 0; point < settings.points; ++point) {
    double sum = 0, squares = 0;
    for (std::uint32_t block = 0; block < blocks; ++block) {
      const glm::vec2& some = sums[std::size_t{block} * settings.points + point];
      sum += double{some.x};
      squares += double{some.y};
    }
    const double mean = sum / walks;
    estimates.means.push_back(mean);
    estimates.variances.push_back((squares / walks - mean * mean) * walks / (walks - 1.0));
  }
  return estimates;
}

}  // namespace tandem::study
