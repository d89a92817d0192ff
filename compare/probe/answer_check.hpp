#pragma once

#include <cstdint>
#include <span>

#include "compare/cause/arbitration.hpp"
#include "compare/cause/difference_class.hpp"
#include "compare/probe/answer.hpp"
#include "compare/probe/field.hpp"
#include "compare/probe/reference.hpp"
#include "compare/probe/trial.hpp"

namespace tandem::compare {

/// What is to be said of two answers to a ray.
struct AnswerCheck {
  DifferenceClass kind = DifferenceClass::rounding;
  const ProbeField* field = nullptr;  ///< the first that differs by more than rounding, else the first that differs
  Ruling ruling = Ruling::tie;
};

/// Whether two answers have different bits; where a trial leaves it open what is hit, whether one hits and one misses.
bool differ(const Trial& trial, const ProbeAnswer& a, const ProbeAnswer& b);

/// Checks two answers that differ. Ids and flags may do so only where rounding decides which primitive is met; numbers
/// by what single precision, 32 units in the last place of the largest coordinate involved, does to them: t by as much
/// as that moves the point where the ray meets the surface, barycentrics by the same over the triangle's height, both
/// more the flatter the ray meets it.
/// @param hits what the reference finds of the ray
AnswerCheck check_answers(const Trial& trial, std::span<const ProbeInstance> instances, const ProbeRay& ray,
                          std::span<const ProbeHit> hits, const ProbeAnswer& a, const ProbeAnswer& b);

/// Whether a device may give this answer. @param hits as for check_answers
bool is_right(const Trial& trial, std::span<const ProbeInstance> instances, const ProbeRay& ray,
              std::span<const ProbeHit> hits, const ProbeAnswer& answer);

}  // namespace tandem::compare
