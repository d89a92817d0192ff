#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "program/amber/value/number.hpp"
#include "program/job/value_type.hpp"

namespace tandem::program::amber {

/// Where the scalars of elements of one type lie that follow each other in memory.
class Values {
 public:
  /// @param stride bytes from one element to the next
  Values(const ValueType& element, std::uint32_t stride);

  std::size_t scalars_per_element() const noexcept { return places_.size(); }
  /// The scalar number `index`, counted through all elements.
  Place place(std::uint64_t index) const;
  /// How many scalars `bytes` bytes hold.
  std::uint64_t count(std::uint64_t bytes) const;

 private:
  std::vector<Place> places_;  ///< of one element
  std::uint64_t stride_;
};

/// The numbers as elements of the type, one after the other, with zeros between them. The last element may be given in
/// part. @pre every number fits its scalar, or is an integer
std::vector<std::byte> bytes_of(std::span<const Number> numbers, const Values& values, std::uint32_t stride);

}  // namespace tandem::program::amber
