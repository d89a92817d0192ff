#include "program/lockstep/recorded_execution.hpp"

#include <algorithm>
#include <cstring>
#include <numeric>

#include "rhi/error.hpp"

namespace tandem::program {

RecordedExecution::RecordedExecution(rhi::Device& device, const RecordedLaunch& launch, const Snapshot& inputs)
    : device_(device), launch_(launch), inputs_(inputs), execution_(device, launch.job) {}

std::vector<std::uint32_t> RecordedExecution::run(const RecordRequest& request, std::span<const std::uint32_t> other,
                                                  bool force) {
  const std::uint64_t size = record_buffer_size(request, !other.empty());
  if (size > device_.info().limits.max_storage_buffer_range)
    throw rhi::Error(rhi::ErrorCode::unsupported, device_.info().name,
                     "a recording of " + std::to_string(size) + " bytes is larger than its largest buffer");
  const std::vector<std::uint32_t> words = record_buffer(request, other, force);
  restore(execution_, inputs_);
  execution_.replace_buffer(launch_.record_buffer, std::as_bytes(std::span(words)));
  execution_.run();
  const std::vector<std::byte> bytes = execution_.buffer(launch_.record_buffer);
  std::vector<std::uint32_t> result(bytes.size() / sizeof(std::uint32_t));
  std::memcpy(result.data(), bytes.data(), bytes.size());
  return result;
}

std::vector<std::uint32_t> RecordedExecution::hashes() {
  RecordRequest request{.launch_size = launch_.size, .largest_segment = launch_.largest_segment};
  request.invocations.resize(invocation_count(request));
  std::iota(request.invocations.begin(), request.invocations.end(), std::uint64_t{0});
  const std::vector<std::uint32_t> buffer = run(request, {}, false);
  const std::span<const std::uint32_t> hashes = hashes_of(request, buffer);
  return {hashes.begin(), hashes.end()};
}

std::uint64_t RecordedExecution::needed_words(std::vector<std::uint64_t> invocations) {
  // Slots without a word say how many they need.
  const RecordRequest request{.launch_size = launch_.size,
                              .invocations = std::move(invocations),
                              .capacity = 0,
                              .largest_segment = launch_.largest_segment};
  const std::vector<std::uint32_t> measured = run(request, {}, false);
  std::uint64_t needed = 1;
  for (std::size_t slot = 0; slot < request.invocations.size(); ++slot)
    needed = std::max(needed, slot_of(request, measured, slot).needed_words);
  return needed;
}

Recording RecordedExecution::record(std::vector<std::uint64_t> invocations, std::uint64_t most_bytes) {
  const std::uint64_t needed = needed_words(invocations);
  Recording recording{.request = {.launch_size = launch_.size,
                                  .invocations = std::move(invocations),
                                  .capacity = 0,
                                  .largest_segment = launch_.largest_segment},
                      .buffer = {}};
  RecordRequest& request = recording.request;
  // The replay's buffer holds two recordings.
  const std::uint64_t largest = std::min(most_bytes, device_.info().limits.max_storage_buffer_range) / 2;
  const std::uint64_t fixed = record_buffer_size(request, false);
  const std::uint64_t available = largest > fixed ? (largest - fixed) / sizeof(std::uint32_t) : 0;
  request.capacity =
      static_cast<std::uint32_t>(std::min(needed, available / std::max<std::uint64_t>(request.invocations.size(), 1)));
  recording.buffer = run(request, {}, false);
  return recording;
}

Recording RecordedExecution::replay(const Recording& other, bool force) {
  return {other.request, run(other.request, other.buffer, force)};
}

Snapshot RecordedExecution::outputs() {
  Snapshot snapshot = inputs_;
  for (std::size_t i = 0; i < snapshot.buffers.size(); ++i) snapshot.buffers[i] = execution_.buffer(i);
  for (std::size_t i = 0; i < snapshot.images.size(); ++i) snapshot.images[i] = execution_.image(i);
  return snapshot;
}

}  // namespace tandem::program
