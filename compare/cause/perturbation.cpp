#include "compare/cause/perturbation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <glm/geometric.hpp>

#include "compare/geometry/rounding.hpp"

namespace tandem::compare {
namespace {

using pathtracer::PathEvent;
using pathtracer::PathEvents;
namespace word = pathtracer::event_word;

constexpr double widening = 4;

/// Numbers in [-1, 1], the same with every standard library.
class Numbers {
 public:
  explicit Numbers(std::uint32_t seed) : generator_(seed) {}
  double next() { return static_cast<double>(generator_()) / 2147483647.5 - 1.0; }
  glm::dvec3 next_vector() {
    const double x = next(), y = next(), z = next();
    return {x, y, z};
  }

 private:
  std::mt19937 generator_;
};

/// What is added to the numbers of a state, in units in the last place.
struct Move {
  glm::dvec3 origin, direction, throughput, radiance, previous;
  double density = 0, eta_scale = 0;
};

Move scaled(const Move& move, double factor) {
  return {.origin = move.origin * factor,
          .direction = move.direction * factor,
          .throughput = move.throughput * factor,
          .radiance = move.radiance * factor,
          .previous = move.previous * factor,
          .density = move.density * factor,
          .eta_scale = move.eta_scale * factor};
}

PathEvent moved(const PathEvent& state, const Move& move) {
  constexpr double unit = std::numeric_limits<float>::epsilon();
  PathEvent result = state;
  const auto position = [&](std::size_t index, const glm::dvec3& by) {
    const glm::vec3 value = state.vector(index);
    result.set(index, glm::vec3(glm::dvec3(value) + by * (unit * largest_magnitude(glm::dvec3(value)))));
  };
  const auto number = [&](std::size_t index, double by) {
    result.set(index, static_cast<float>(double{state.number(index)} * (1.0 + unit * by)));
  };
  const auto color = [&](std::size_t index, const glm::dvec3& by) {
    for (int i = 0; i < 3; ++i) number(index + static_cast<std::size_t>(i), by[i]);
  };
  position(word::segment_origin, move.origin);
  position(word::segment_previous_position, move.previous);
  const glm::dvec3 direction(state.vector(word::segment_direction));
  const glm::dvec3 turned = direction + move.direction * (unit * largest_magnitude(direction));
  result.set(word::segment_direction, glm::vec3(turned * (glm::length(direction) / glm::length(turned))));
  color(word::segment_throughput, move.throughput);
  color(word::segment_radiance, move.radiance);
  number(word::segment_previous_density, move.density);
  number(word::segment_eta_scale, move.eta_scale);
  return result;
}

/// Whether exact fields before `place` say the same in both.
bool takes_the_same_course(std::span<const PathEvent> a, std::span<const PathEvent> b, EventPlace place) {
  // The state itself, at 0, is what was perturbed.
  for (std::size_t i = 1; i <= place.event; ++i) {
    if (i >= a.size() || i >= b.size() || a[i].kind() != b[i].kind()) return false;
    const std::span<const EventField> fields = fields_of(a[i].kind());
    const std::size_t count = i < place.event ? fields.size() : std::min(place.field, fields.size());
    for (const EventField& field : fields.first(count))
      if (field.tier == FieldTier::exact && !is_equal(field, a[i], b[i])) return false;
  }
  return true;
}

/// Whether a variation of a device that goes on as `own` decides as `other`.
bool decides_as(std::span<const PathEvent> variation, std::span<const PathEvent> own, std::span<const PathEvent> other,
                EventPlace place) {
  const EventField* const field = field_at(own, other, place);
  if (place.event >= variation.size() || place.event >= other.size()) return false;
  if (variation[place.event].kind() != other[place.event].kind()) return false;
  if (!field)
    return takes_the_same_course(variation, own, {place.event - 1, fields_of(own[place.event - 1].kind()).size()});
  return takes_the_same_course(variation, own, place) && is_equal(*field, variation[place.event], other[place.event]);
}

/// Largest difference of the components; infinite where one is not finite and the bits differ.
double distance(const EventField& field, const PathEvent& a, const PathEvent& b) {
  double largest = 0;
  for (std::size_t i = field.word; i < field.word + word_count(field.type); ++i) {
    if (a.words[i] == b.words[i]) continue;
    const double difference = std::abs(double{a.number(i)} - double{b.number(i)});
    if (!std::isfinite(difference)) return std::numeric_limits<double>::infinity();
    largest = std::max(largest, difference);
  }
  return largest;
}

/// How far variations take a value from where it is; not counting those that leave the course or the finite numbers.
double spread(std::span<const PathEvents> variations, std::span<const PathEvent> own, EventPlace place,
              const EventField& field) {
  double largest = 0;
  for (const PathEvents& variation : variations) {
    if (!takes_the_same_course(variation, own, place)) continue;
    const double from_own = distance(field, variation[place.event], own[place.event]);
    if (std::isfinite(from_own)) largest = std::max(largest, from_own);
  }
  return largest;
}

/// Whether a value that is not finite is also what a variation comes to.
bool occurs(std::span<const PathEvents> variations, std::span<const PathEvent> own, std::span<const PathEvent> other,
            EventPlace place, const EventField& field) {
  return std::any_of(variations.begin(), variations.end(), [&](const PathEvents& variation) {
    return takes_the_same_course(variation, own, place) && is_equal(field, variation[place.event], other[place.event]);
  });
}

}  // namespace

std::vector<PathEvent> perturbed_states(const PathEvent& state) {
  Numbers numbers(state.words[word::segment_direction] ^ state.words[word::segment_origin]);
  std::vector<PathEvent> states;
  for (std::size_t i = 0; i < variation_count / 2; ++i) {
    const Move move = {.origin = numbers.next_vector(),
                       .direction = numbers.next_vector(),
                       .throughput = numbers.next_vector(),
                       .radiance = numbers.next_vector(),
                       .previous = numbers.next_vector(),
                       .density = numbers.next(),
                       .eta_scale = numbers.next()};
    // Small moves too: what lies between two thresholds that are close to each other is not missed.
    static constexpr double sizes[] = {tolerated_ulp, tolerated_ulp / 4, tolerated_ulp / 2, tolerated_ulp / 16};
    const double size = sizes[i % std::size(sizes)];
    for (const double sign : {1.0, -1.0}) states.push_back(moved(state, scaled(move, sign * size)));
  }
  return states;
}

bool explains_decision(const Variations& variations, std::span<const PathEvent> a, std::span<const PathEvent> b,
                       EventPlace place) {
  if (place.event == 0 || place.event >= a.size() || place.event >= b.size()) return false;
  const auto any = [&](const std::vector<PathEvents>& all, std::span<const PathEvent> own,
                       std::span<const PathEvent> other) {
    return std::any_of(all.begin(), all.end(),
                       [&](const PathEvents& variation) { return decides_as(variation, own, other, place); });
  };
  return any(variations.a, a, b) || any(variations.b, b, a);
}

bool explains_value(const Variations& variations, std::span<const PathEvent> a, std::span<const PathEvent> b,
                    EventPlace place) {
  const EventField* const field = field_at(a, b, place);
  if (!field || place.event == 0) return false;
  const double difference = distance(*field, a[place.event], b[place.event]);
  if (!std::isfinite(difference))
    return occurs(variations.a, a, b, place, *field) || occurs(variations.b, b, a, place, *field);
  return difference <= widening * spread(variations.a, a, place, *field) ||
         difference <= widening * spread(variations.b, b, place, *field);
}

}  // namespace tandem::compare
