#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "pathtracer/render/path_event.hpp"

/// What the words of an event mean: the table that comparisons, texts and reports go by.
namespace tandem::compare {

enum class FieldType {
  index,    ///< a number that names something; 2^32 - 1 names nothing
  count,    ///< a whole number
  bits,     ///< random bits
  flag,     ///< 0 or 1
  choice,   ///< one of a few names: field_text
  number,   ///< a float
  vector3,  ///< three floats: a position or a direction; compared against its largest component
  color,    ///< three floats: radiance, throughput, a weight; likewise
  pair      ///< two floats
};

/// How two devices may differ in a field when all before it is equal.
enum class FieldTier {
  exact,    ///< not at all, unless a decision lay within rounding
  carried,  ///< by rounding: the path goes on with the value
  observed  ///< by the tolerance of the contract: no result depends on it
};

struct EventField {
  const char* name;  ///< "throughput"
  std::size_t word;  ///< first of its words
  FieldType type;
  FieldTier tier;
  /// Largest difference that is rounding, relative to the larger magnitude (vectors: largest component), where all
  /// inputs have the same bits. Of exact fields 0.
  double tolerance;
};

/// In the order in which a shader computes them.
std::span<const EventField> fields_of(pathtracer::EventKind kind);

/// "camera", "segment", "ray", ..., "light sample", "direct light".
const char* name(pathtracer::EventKind kind);

/// How many words a field has.
std::size_t word_count(FieldType type);

/// The number in [0, 1) that a path tracer makes of random bits: unit_interval of shaders/random.glsl.
float unit_interval(std::uint32_t bits);

/// The value for people: "0.25, 0.5, 1", "triangle 12"-like names only where the event says so (choices), "none" for
/// 2^32 - 1.
std::string field_text(const EventField& field, const pathtracer::PathEvent& event);

/// The largest distance of two floats of the field in units in the last place; of whole numbers 0 when equal, else
/// 2^32 - 1. A NaN is as far from anything but its own bits.
std::uint32_t ulp_distance(const EventField& field, const pathtracer::PathEvent& a, const pathtracer::PathEvent& b);

/// |a - b| over the larger magnitude; infinite where either is not finite and the bits differ.
double relative_difference(const EventField& field, const pathtracer::PathEvent& a, const pathtracer::PathEvent& b);

/// Whether the words of the field have the same bits in both.
bool is_equal(const EventField& field, const pathtracer::PathEvent& a, const pathtracer::PathEvent& b);

}  // namespace tandem::compare
