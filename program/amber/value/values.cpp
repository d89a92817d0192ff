#include "program/amber/value/values.hpp"

#include <algorithm>

namespace tandem::program::amber {

Values::Values(const ValueType& element, std::uint32_t stride) : stride_(stride) {
  const std::uint64_t count = scalar_count(element, element.size);
  for (std::uint64_t i = 0; i < count; ++i) places_.push_back(place_of(element, element.size, i));
}

Place Values::place(std::uint64_t index) const {
  Place place = places_[index % places_.size()];
  place.offset += index / places_.size() * stride_;
  return place;
}

std::uint64_t Values::count(std::uint64_t bytes) const {
  const std::uint64_t whole = bytes / stride_;
  const std::uint64_t rest = bytes - whole * stride_;
  const auto in_rest = std::count_if(places_.begin(), places_.end(),
                                     [&](const Place& place) { return place.offset + size_of(place.scalar) <= rest; });
  return whole * places_.size() + static_cast<std::uint64_t>(in_rest);
}

std::vector<std::byte> bytes_of(std::span<const Number> numbers, const Values& values, std::uint32_t stride) {
  const std::uint64_t elements = (numbers.size() + values.scalars_per_element() - 1) / values.scalars_per_element();
  std::vector<std::byte> bytes(elements * stride);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const Place place = values.place(i);
    write(std::span(bytes).subspan(place.offset), place.scalar, numbers[i]);
  }
  return bytes;
}

}  // namespace tandem::program::amber
