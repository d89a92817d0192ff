#include "tools/kernels/kernel_run.hpp"

#include <fmt/format.h>

#include <chrono>
#include <utility>

#include "rhi/glsl/compile.hpp"
#include "rhi/transfer.hpp"

namespace tandem::kernels {
namespace {

using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

rhi::BoundResource resource(rhi::Device& device, const Input& input, const std::string& label) {
  if (input.image_side == 0)
    return rhi::BufferRange{rhi::create_filled(device, input.words, rhi::BufferUsage::storage, label)};
  const rhi::TextureHandle texture = rhi::create_filled(
      device, input.words,
      {.format = rhi::TextureFormat::r32_float, .size = {input.image_side, input.image_side, 1}, .label = label});
  constexpr rhi::AddressMode clamp = rhi::AddressMode::clamp_to_edge;
  rhi::SampledTexture sampled;
  sampled.view.texture = texture;
  sampled.sampler = device.create_sampler({.address = {clamp, clamp, clamp}, .label = label});
  return sampled;
}

}  // namespace

KernelRun::KernelRun(rhi::DeviceHandle device, const Kernel& kernel, const Problem& problem)
    : device_(std::move(device)), kernel_(kernel), problem_(problem) {
  const std::string label = kernel.name;
  const Clock::time_point start = Clock::now();
  const Words spirv = glsl::compile(kernel.source(), rhi::ShaderStage::compute, label);
  const rhi::ComputePipelineHandle pipeline =
      device_->create_compute_pipeline({.shader = device_->create_shader_module({.spirv = spirv, .label = label}),
                                        .specialization = {},
                                        .label = label});
  compile_milliseconds_ = milliseconds_since(start);

  answer_ = device_->create_buffer({.size = problem.expected.size() * sizeof(std::uint32_t), .label = label});
  std::vector<rhi::BindGroupEntry> entries = {{.binding = 0, .resource = rhi::BufferRange{answer_}}};
  for (const Input& input : problem.inputs)
    entries.push_back(
        {.binding = static_cast<std::uint32_t>(entries.size()), .resource = resource(*device_, input, label)});
  const rhi::BindGroupHandle group =
      device_->create_bind_group({.pipeline = pipeline, .entries = entries, .label = label});

  wipe_ = device_->create_command_list(label);
  wipe_->fill({answer_}, ~0U);  // no number that a kernel answers, and NaN
  list_ = device_->create_command_list(label);
  if (device_->info().capabilities.timestamps) timestamps_ = device_->create_query_pool({.count = 2, .label = label});
  if (timestamps_) list_->write_timestamp(timestamps_, 0);
  list_->dispatch({.pipeline = pipeline,
                   .bind_groups = {group},
                   .push_constants = std::as_bytes(std::span(problem.push_constants)),
                   .workgroup_count = problem.workgroup_count});
  if (timestamps_) list_->write_timestamp(timestamps_, 1);
}

double KernelRun::run() {
  device_->submit(wipe_)->wait();
  const Clock::time_point start = Clock::now();
  device_->submit(list_)->wait();
  double milliseconds = milliseconds_since(start);
  if (timestamps_) {
    const std::vector<double> times = timestamps_->timestamps_ns();
    milliseconds = (times[1] - times[0]) * 1e-6;
  }
  const Words answer = rhi::read<std::uint32_t>(*device_, answer_, problem_.expected.size());
  if (const std::string what = mistake(problem_, answer); !what.empty())
    throw WrongAnswer(
        fmt::format("the kernel '{}' answers wrongly on {}: {}", kernel_.name, device_->info().name, what));
  return milliseconds;
}

}  // namespace tandem::kernels
