#include "program/execute/execution.hpp"

#include <chrono>
#include <utility>

#include "program/execute/pipelines.hpp"
#include "program/execute/position.hpp"
#include "program/execute/resources.hpp"
#include "rhi/transfer.hpp"

namespace tandem::program {

struct Execution::State {
  rhi::Device& device;
  const Job& job;
  Resources resources;
  std::vector<BoundPipeline> pipelines;

  const rhi::BufferHandle& buffer(std::size_t index) const {
    return at_position(resources.buffers, index, "", "buffer");
  }
  const rhi::TextureHandle& image(std::size_t index) const { return at_position(resources.images, index, "", "image"); }

  void record(const Command& command, rhi::CommandList& list) const {
    std::visit([&](const auto& each) { record(each, list); }, command);
  }
  void record(const Dispatch& command, rhi::CommandList& list) const;
  void record(const TraceRays& command, rhi::CommandList& list) const;
  void record(const CopyBuffer& command, rhi::CommandList& list) const;
  void record(const CopyImage& command, rhi::CommandList& list) const;
  void record(const CopyImageToBuffer& command, rhi::CommandList& list) const;
  void record(const CopyBufferToImage& command, rhi::CommandList& list) const;
};

namespace {

rhi::ShaderRecords records_of(const std::vector<Record>& records) {
  rhi::ShaderRecords result;
  for (const Record& record : records) result.records.push_back({.shader = record.shader, .data = record.data});
  return result;
}

void require_bytes(std::size_t given, std::uint64_t wanted, const std::string& label) {
  if (given != wanted)
    throw rhi::Error(rhi::ErrorCode::invalid_argument, label,
                     std::to_string(given) + " bytes for the " + std::to_string(wanted) + " that it has");
}

}  // namespace

void Execution::State::record(const Dispatch& command, rhi::CommandList& list) const {
  const BoundPipeline& pipeline = at_position(pipelines, command.pipeline, "dispatch", "pipeline");
  list.dispatch({.pipeline = pipeline.compute,
                 .bind_groups = pipeline.bind_groups,
                 .push_constants = pipeline.push_constants,
                 .workgroup_count = command.workgroup_count,
                 .base_workgroup = command.base_workgroup});
}

void Execution::State::record(const TraceRays& command, rhi::CommandList& list) const {
  const BoundPipeline& pipeline = at_position(pipelines, command.pipeline, "trace rays", "pipeline");
  list.trace_rays({.table = device.create_shader_table({.pipeline = pipeline.ray_tracing,
                                                        .ray_generation = records_of({command.ray_generation}),
                                                        .miss = records_of(command.miss),
                                                        .hit = records_of(command.hit),
                                                        .callable = records_of(command.callable),
                                                        .label = job.pipelines[command.pipeline].name}),
                   .bind_groups = pipeline.bind_groups,
                   .push_constants = pipeline.push_constants,
                   .size = command.size,
                   .indirect_size = {}});
}

void Execution::State::record(const CopyBuffer& command, rhi::CommandList& list) const {
  const rhi::BufferHandle& source = buffer(command.source);
  list.copy({source}, {.buffer = buffer(command.destination), .size = source->size()});
}

void Execution::State::record(const CopyImage& command, rhi::CommandList& list) const {
  const rhi::TextureHandle& source = image(command.source);
  const rhi::BufferHandle staging = device.create_buffer({.size = source->size_in_bytes(),
                                                          .usage = rhi::BufferUsage::none,
                                                          .label = "staging of " + source->desc().label});
  list.copy_from_texture(source, {staging});
  list.copy_to_texture({staging}, image(command.destination));
}

void Execution::State::record(const CopyImageToBuffer& command, rhi::CommandList& list) const {
  const rhi::TextureHandle& source = image(command.source);
  list.copy_from_texture(source, {.buffer = buffer(command.destination), .size = source->size_in_bytes()});
}

void Execution::State::record(const CopyBufferToImage& command, rhi::CommandList& list) const {
  const rhi::TextureHandle& destination = image(command.destination);
  list.copy_to_texture({.buffer = buffer(command.source), .size = destination->size_in_bytes()}, destination);
}

Execution::Execution(rhi::Device& device, const Job& job) {
  Resources resources = make_resources(device, job);
  std::vector<BoundPipeline> pipelines = make_pipelines(device, job, resources);
  state_ = std::make_unique<State>(State{device, job, std::move(resources), std::move(pipelines)});
}

Execution::~Execution() = default;

void Execution::run(const Command& command) {
  const rhi::CommandListHandle list = state_->device.create_command_list("a command of the job");
  state_->record(command, *list);
  state_->device.submit(list)->wait();
}

void Execution::run() {
  for (const Command& command : state_->job.commands) run(command);
}

double Execution::timed_run() { return timed_run(state_->job.commands); }

double Execution::timed_run(std::span<const Command> commands) {
  rhi::Device& device = state_->device;
  const rhi::CommandListHandle list = device.create_command_list("the job");
  rhi::QueryPoolHandle times;
  if (device.info().capabilities.timestamps) {
    times = device.create_query_pool({.count = 2, .label = "times of the job"});
    list->write_timestamp(times, 0);
  }
  for (const Command& command : commands) state_->record(command, *list);
  if (times != nullptr) list->write_timestamp(times, 1);
  const auto start = std::chrono::steady_clock::now();
  device.submit(list)->wait();
  if (times == nullptr)
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  const std::vector<double> nanoseconds = times->timestamps_ns();
  return (nanoseconds[1] - nanoseconds[0]) * 1e-6;
}

std::vector<std::byte> Execution::buffer(std::size_t index) {
  const rhi::BufferHandle& buffer = state_->buffer(index);
  return rhi::read<std::byte>(state_->device, buffer, static_cast<std::size_t>(buffer->size()));
}

std::vector<std::byte> Execution::image(std::size_t index) { return rhi::read(state_->device, state_->image(index)); }

void Execution::set_buffer(std::size_t index, std::span<const std::byte> bytes) {
  const rhi::BufferHandle& buffer = state_->buffer(index);
  require_bytes(bytes.size(), buffer->size(), buffer->desc().label);
  const rhi::CommandListHandle list = state_->device.create_command_list("upload of " + buffer->desc().label);
  list->upload(buffer, 0, bytes);
  state_->device.submit(list)->wait();
}

void Execution::replace_buffer(std::size_t index, std::span<const std::byte> bytes) {
  state_->buffer(index);  // there is one
  if (bytes.empty()) return;
  state_->resources.buffers[index] = make_buffer(state_->device, state_->job, index, bytes);
  bind_again(state_->device, state_->job, state_->resources, state_->pipelines);
}

void Execution::set_image(std::size_t index, std::span<const std::byte> bytes) {
  const rhi::TextureHandle& image = state_->image(index);
  const std::string& label = image->desc().label;
  require_bytes(bytes.size(), image->size_in_bytes(), label);
  const rhi::CommandListHandle list = state_->device.create_command_list("upload of " + label);
  list->copy_to_texture(
      {rhi::create_filled(state_->device, *list, bytes, rhi::BufferUsage::none, "staging of " + label)}, image);
  state_->device.submit(list)->wait();
}

}  // namespace tandem::program
