#pragma once

#include <cstdint>

namespace tandem::cpu {

/// Wide form: what an instruction is printed for.
enum class Mode : std::uint8_t {
  common,  ///< all lanes at once, with what they have in common; in the scalar form, everything
  wide,    ///< all lanes at once, each with its own values
  lane     ///< the lane `lane`
};

}  // namespace tandem::cpu
