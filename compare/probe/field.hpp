#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "compare/probe/answer.hpp"

namespace tandem::compare {

/// One word of a ProbeAnswer.
struct ProbeField {
  enum class Kind {
    identity,  ///< says which primitive is hit
    flag,      ///< says something of that primitive, exactly
    number     ///< a 32-bit float
  };

  const char* name;  ///< "t", "object to world (1, 3)"
  Kind kind;
  std::size_t offset;  ///< bytes
};

/// All of them, in the order in which they are compared.
std::span<const ProbeField> probe_fields();

/// The field's 32 bits.
std::uint32_t bits_of(const ProbeAnswer& answer, const ProbeField& field);

}  // namespace tandem::compare
