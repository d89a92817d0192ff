#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "pathtracer/render/event_word.hpp"
#include "pathtracer/render/traced_ray.hpp"

/// What happens along a path, as shaders/integrator/events.glsl writes it down, byte for byte (std430).
namespace tandem::pathtracer {

enum class EventKind : std::uint32_t {
  camera = 1,         ///< the path begins
  segment = 2,        ///< a segment begins: all that the rest of the path depends on
  ray = 3,            ///< a ray was traced
  surface = 4,        ///< the segment met a surface
  medium = 5,         ///< the segment ran through a medium
  emission = 6,       ///< light that the segment met
  light_sample = 7,   ///< a light was chosen
  light_value = 8,    ///< it may light the vertex
  visibility = 9,     ///< how much of it arrives
  direct_light = 10,  ///< what it adds
  scatter = 11,       ///< the vertex scattered
  roulette = 12,
  end = 13
};
inline constexpr std::uint32_t event_kind_count = 13;

enum class EndReason : std::uint32_t {
  escaped = 0,   ///< left the scene
  depth = 1,     ///< was as long as settings allow
  absorbed = 2,  ///< carried nothing any more
  roulette = 3,
  side = 4,       ///< was scattered to the wrong side of the true surface
  crossings = 5,  ///< crossed too many boundaries of media
  occluded = 6,   ///< ambient occlusion: met something
  limit = 7       ///< as many segments are recorded as were asked for
};

/// What a device reports of a closest hit.
enum class HitKind : std::uint32_t { none = 0, front = 1, back = 2, procedural = 3 };

/// One event. pathtracer/render/event_word.hpp says where its values are.
struct PathEvent {
  std::array<std::uint32_t, 32> words{};

  EventKind kind() const { return static_cast<EventKind>(words[0]); }
  /// Path segments before it, those that end where a medium begins included; 0 is the camera's.
  std::uint32_t segment() const { return words[1]; }
  float number(std::size_t word) const { return std::bit_cast<float>(words[word]); }
  glm::vec3 vector(std::size_t word) const { return {number(word), number(word + 1), number(word + 2)}; }
  void set(std::size_t word, float value) { words[word] = std::bit_cast<std::uint32_t>(value); }
  void set(std::size_t word, const glm::vec3& value) {
    for (int i = 0; i < 3; ++i) set(word + static_cast<std::size_t>(i), value[i]);
  }

  bool operator==(const PathEvent&) const = default;
};
static_assert(sizeof(PathEvent) == 128);

/// Which path: one sample of one pixel.
struct PathId {
  glm::uvec2 pixel{0};
  std::uint32_t sample = 0;

  bool operator==(const PathId&) const = default;
};

inline constexpr std::uint32_t all_segments = 0xffffffffu;

/// A path to be recorded, from the camera on or from a segment on.
struct PathStart {
  PathId path;
  /// An event of kind segment, recorded on whatever device, or made from one: the path goes on with that segment. Its
  /// random numbers are those of `path`.
  std::optional<PathEvent> state = {};
  std::uint32_t segment_count = all_segments;  ///< recording ends (EndReason::limit) after so many segments
};

/// What a recording comes to.
struct PathSummary {
  glm::vec3 radiance{0};  ///< what the path adds to its pixel's sum; from a state: that of the state included
  std::uint32_t ray_count = 0;
  std::uint32_t event_count = 0;
  /// Of all words of all events but event_word::hit_t and hit_barycentrics.
  std::uint32_t digest = 0;
  std::array<std::uint32_t, 2> reserved{};  ///< whatever the device has there

  /// Whether both have the same bits, `reserved` aside: a NaN equals itself, and the two zeros differ.
  bool operator==(const PathSummary& other) const;
};
static_assert(sizeof(PathSummary) == 32);

using PathEvents = std::vector<PathEvent>;

/// The rays among the events of a path, in order, with their answers.
std::vector<TracedRay> rays_of(const PathId& path, std::span<const PathEvent> events);

/// The ray that an event of kind ray is about.
TracedRay ray_of(const PathId& path, const PathEvent& event);

}  // namespace tandem::pathtracer
