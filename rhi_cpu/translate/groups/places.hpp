#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <spirv_cross/spirv.hpp>

/// How far an invocation is when it comes to a subgroup operation (kernel::Position).
namespace tandem::cpu {

/// Instructions for which the invocations of a subgroup meet: all that ask other invocations.
bool is_meeting(spv::Op op);

/// A meeting, or a call of a function that has some.
struct Place {
  std::vector<std::uint32_t> loops;  ///< around it, the outermost first: of MarkedModule::loops
  std::uint32_t number = 0;          ///< in program order of its function; from 1
};

/// A loop with places in it.
struct MarkedLoop {
  std::uint32_t number = 0;          ///< as a place's: below those of the places in it, above those before
  std::vector<std::uint32_t> inner;  ///< the loops with places that are directly in it
};

/// A module with marks, instructions whose one operand is an index with mark_bit set.
struct MarkedModule {
  std::vector<std::uint32_t> words = {};
  std::vector<Place> places = {};
  std::vector<MarkedLoop> loops = {};
  std::uint32_t depth = 0;  ///< words of the longest position; 0 without places
};

/// So that no mark's operand is an id.
inline constexpr std::uint32_t mark_bit = 1u << 31;

/// Stands before a meeting or a call; its operand is the index of the place.
inline constexpr spv::Op place_mark = spv::OpLifetimeStop;
/// Stands in the header of a loop where its rounds are counted.
inline constexpr spv::Op round_mark = spv::OpRetainEvent;
/// Stands where a function begins, for each of its loops.
inline constexpr spv::Op loop_declaration = spv::OpReleaseEvent;

/// Whether the invocations of a subgroup meet anywhere in a valid module. They do not at barriers of the workgroup.
bool has_meetings(std::span<const std::uint32_t> spirv);

/// Marks the places of a valid module. Program order is the structured one of the SPIR-V specification: a header comes
/// before what it dominates, and its merge block after that.
MarkedModule with_marked_places(std::span<const std::uint32_t> spirv);

}  // namespace tandem::cpu
