#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "program/amber/position.hpp"
#include "program/amber/value/number.hpp"
#include "program/amber/value/texel.hpp"
#include "program/job/value_type.hpp"

namespace tandem::program::amber {

/// A buffer or an image of the job.
struct Storage {
  enum class Kind : std::uint8_t { buffer, image };

  Kind kind = Kind::buffer;
  std::size_t index = 0;  ///< in Job::buffers or Job::images
};

enum class Comparison : std::uint8_t { equal, not_equal, less, less_or_equal, greater, greater_or_equal };

/// How far a value may be from what is expected.
struct Tolerance {
  double value = 0;
  bool percent = false;  ///< of what is expected
};

/// EXPECT name IDX offset [TOLERANCE ...] EQ values: the scalars from the element at the offset on. EQ and NE allow
/// floating-point numbers a relative difference of 1e-8, as Amber does; NaN equals NaN.
struct ValuesExpectation {
  ValueType element;
  std::uint32_t stride = 4;  ///< bytes from one element to the next
  std::uint64_t offset = 0;  ///< bytes
  Comparison comparison = Comparison::equal;
  std::vector<Tolerance> tolerances = {};  ///< one for all components, or one for each of the first ones
  std::vector<Number> values;
};

/// EXPECT name IDX x y SIZE width height EQ_RGB(A): every texel of a rectangle. Numbers are thought of as in [0, 1],
/// those of integer formats as they are.
struct TexelsExpectation {
  Texel texel;
  std::array<std::uint32_t, 2> size = {};  ///< of the image
  std::array<std::uint32_t, 2> first = {};
  std::array<std::uint32_t, 2> count = {};
  std::array<std::uint8_t, 4> color = {};
  bool alpha = false;
  std::vector<Tolerance> tolerances = {};  ///< one for all components, or one for each; none: 0.002
};

/// EXPECT name EQ_BUFFER other, and the two that measure a distance.
struct BuffersExpectation {
  enum class Measure : std::uint8_t {
    equal,                  ///< all bytes
    root_mean_square,       ///< of the differences of all scalars
    histogram_earth_movers  ///< of four 8-bit components: the largest distance of the two histograms of one, in [0, 1]
  };

  Measure measure = Measure::equal;
  Storage other;
  std::string other_name;
  ValueType element;
  std::uint32_t stride = 4;
  double tolerance = 0;
};

struct Expectation {
  Position position;
  std::string name;  ///< of the buffer or image
  Storage storage;
  std::variant<ValuesExpectation, TexelsExpectation, BuffersExpectation> what;
};

/// Why the contents are not what is expected, as a sentence without a full stop; "" when they are.
/// @param other the contents of BuffersExpectation::other; empty for the other expectations
std::string failure(const Expectation& expectation, std::span<const std::byte> contents,
                    std::span<const std::byte> other);

}  // namespace tandem::program::amber
