#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "program/record/instrument.hpp"

/// What the recorders of a launch wrote.
namespace tandem::program {

/// Which invocations of a launch record, and how much.
struct RecordRequest {
  std::array<std::uint32_t, 3> launch_size = {1, 1, 1};  ///< invocations
  std::vector<std::uint64_t> invocations = {};           ///< their numbers, x first; the position is the slot
  std::uint32_t capacity = 0;                            ///< words of a slot; 0 with RecordForm::hash
  std::uint32_t largest_segment = 1;                     ///< words, of all segments that may run
};

std::uint64_t invocation_count(const RecordRequest& request);
std::array<std::uint32_t, 3> id_of(const RecordRequest& request, std::uint64_t invocation);

/// Bytes of the buffer. @param lockstep with the other device's recording
std::uint64_t record_buffer_size(const RecordRequest& request, bool lockstep);

/// The buffer's contents before the launch.
/// @param other what another device recorded with the same request: the buffer is for RecordForm::lockstep
/// @param force whether its results are taken
std::vector<std::uint32_t> record_buffer(const RecordRequest& request, std::span<const std::uint32_t> other,
                                         bool force);

/// What a slot holds after the launch.
struct SlotView {
  std::span<const std::uint32_t> words;
  bool complete = true;            ///< the capacity sufficed
  std::uint64_t needed_words = 0;  ///< the capacity that would
  std::uint32_t first_word = 0;    ///< of the slot, in the buffer: what the words behind calls count from
};

/// @param buffer the contents after the launch
SlotView slot_of(const RecordRequest& request, std::span<const std::uint32_t> buffer, std::size_t slot);

/// The words of RecordForm::hash, by slot.
std::span<const std::uint32_t> hashes_of(const RecordRequest& request, std::span<const std::uint32_t> buffer);

}  // namespace tandem::program
