#pragma once

#include <cstdint>

/// The buffer into which recorders write: words of 32 bits.
///
///     0              the header (RecordHeader)
///     trash          what invocations write that are not recorded
///     table          for each invocation of the launch, x first: its slot + 1, or 0 where it is not recorded
///     cursors        for each slot: the word behind its last one; with RecordForm::hash, its hash
///     slots          `capacity` words each
///
/// For RecordForm::lockstep the same follows once more, `delta` words on: what the other device wrote.
namespace tandem::program {

/// Positions of the header's words.
enum RecordHeader : std::uint32_t {
  header_force,  ///< not 0: the other device's results are taken
  header_width,  ///< invocations of the launch along x
  header_area,   ///< along x times along y
  header_delta,
  header_table,
  header_cursors,
  header_capacity,
  header_slots,
  header_trash_cursor,  ///< of all invocations that are not recorded
  header_words
};

/// Where the words of invocations without a slot go.
inline constexpr std::uint32_t trash_start = header_words;

}  // namespace tandem::program
