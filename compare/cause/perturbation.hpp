#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "compare/path/recording_difference.hpp"
#include "pathtracer/render/path_event.hpp"

/// What rounding may make of a segment: the same segment is run again from states that differ from its own by a few
/// units in the last place.
namespace tandem::compare {

/// The number of perturbed states that are tried. About half of them flip a decision that lies within their reach of
/// its threshold, so the probability that none does is about 2^-64.
inline constexpr std::size_t variation_count = 64;

/// Events of kind segment with the state of `state`, moved by up to tolerated_ulp units in the last place
/// (compare/geometry/rounding.hpp): origin, direction and scatterer position by those of their largest
/// component, the direction then of unit length again; throughput, radiance and densities each by their own, so that
/// what is black stays black. Every second state is moved the other way than the one before it. The same for the same
/// state.
std::vector<pathtracer::PathEvent> perturbed_states(const pathtracer::PathEvent& state);

/// What devices make of perturbed states: recordings of that one segment.
struct Variations {
  std::vector<pathtracer::PathEvents> a, b;
};

/// Whether rounding explains that two devices decide differently at `place`: one of the variations on a decides as b
/// does, after the same course, or the other way round.
/// @param a,b the segment, from its own state on; up to `place` their exact fields agree
bool explains_decision(const Variations& variations, std::span<const pathtracer::PathEvent> a,
                       std::span<const pathtracer::PathEvent> b, EventPlace place);

/// Whether rounding explains the distance of two values at `place`: it is at most four times as large as what the
/// variations on one of the devices differ by from its own value. Four, because the value of b is rounded in each of
/// the operations between, and the variations in the first only. A value that is not finite counts only as itself.
bool explains_value(const Variations& variations, std::span<const pathtracer::PathEvent> a,
                    std::span<const pathtracer::PathEvent> b, EventPlace place);

}  // namespace tandem::compare
