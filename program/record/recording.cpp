#include "program/record/recording.hpp"

#include <algorithm>

#include "program/record/buffer_layout.hpp"

namespace tandem::program {
namespace {

/// Positions of the parts, in words.
struct Layout {
  std::uint64_t table, cursors, slots, end;
};

Layout layout_of(const RecordRequest& request) {
  Layout layout{};
  layout.table = trash_start + request.largest_segment;
  layout.cursors = layout.table + invocation_count(request);
  layout.slots = layout.cursors + request.invocations.size();
  layout.end = layout.slots + std::uint64_t{request.capacity} * request.invocations.size();
  return layout;
}

}  // namespace

std::uint64_t invocation_count(const RecordRequest& request) {
  return std::uint64_t{request.launch_size[0]} * request.launch_size[1] * request.launch_size[2];
}

std::array<std::uint32_t, 3> id_of(const RecordRequest& request, std::uint64_t invocation) {
  const std::uint64_t width = request.launch_size[0], height = request.launch_size[1];
  return {static_cast<std::uint32_t>(invocation % width), static_cast<std::uint32_t>(invocation / width % height),
          static_cast<std::uint32_t>(invocation / width / height)};
}

std::uint64_t record_buffer_size(const RecordRequest& request, bool lockstep) {
  return layout_of(request).end * (lockstep ? 2 : 1) * sizeof(std::uint32_t);
}

std::vector<std::uint32_t> record_buffer(const RecordRequest& request, std::span<const std::uint32_t> other,
                                         bool force) {
  const Layout layout = layout_of(request);
  std::vector<std::uint32_t> words(layout.end * (other.empty() ? 1 : 2));
  const auto word = [](std::uint64_t value) { return static_cast<std::uint32_t>(value); };
  words[header_force] = force ? 1 : 0;
  words[header_width] = request.launch_size[0];
  words[header_area] = request.launch_size[0] * request.launch_size[1];
  words[header_delta] = other.empty() ? 0 : word(layout.end);
  words[header_table] = word(layout.table);
  words[header_cursors] = word(layout.cursors);
  words[header_capacity] = request.capacity;
  words[header_slots] = word(layout.slots);
  for (std::size_t slot = 0; slot < request.invocations.size(); ++slot) {
    words[layout.table + request.invocations[slot]] = word(slot + 1);
    words[layout.cursors + slot] = word(layout.slots + slot * request.capacity);
  }
  if (!other.empty())
    std::copy_n(other.begin(), std::min<std::size_t>(other.size(), layout.end),
                words.begin() + static_cast<std::ptrdiff_t>(layout.end));
  return words;
}

SlotView slot_of(const RecordRequest& request, std::span<const std::uint32_t> buffer, std::size_t slot) {
  const Layout layout = layout_of(request);
  const std::uint64_t start = layout.slots + slot * request.capacity;
  const std::uint64_t needed = buffer[layout.cursors + slot] - start;
  return {.words = buffer.subspan(start, std::min<std::uint64_t>(needed, request.capacity)),
          .complete = needed <= request.capacity,
          .needed_words = needed,
          .first_word = static_cast<std::uint32_t>(start)};
}

std::span<const std::uint32_t> hashes_of(const RecordRequest& request, std::span<const std::uint32_t> buffer) {
  return buffer.subspan(layout_of(request).cursors, request.invocations.size());
}

}  // namespace tandem::program
