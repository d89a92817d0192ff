#pragma once

#include <cstddef>

/// Which word of an event (PathEvent::words) holds what, as shaders/integrator/events.glsl packs them: the one place
/// on the host that knows. Word 0 is the kind of the event, word 1 its segment. A vector takes three words, a pair two.
/// compare/path/event_fields.hpp says what the values mean.
namespace tandem::pathtracer::event_word {

inline constexpr std::size_t camera_pixel_x = 2;
inline constexpr std::size_t camera_pixel_y = 3;
inline constexpr std::size_t camera_origin = 4;
inline constexpr std::size_t camera_sample = 7;
inline constexpr std::size_t camera_direction = 8;
inline constexpr std::size_t camera_time = 11;

inline constexpr std::size_t segment_depth = 2;
inline constexpr std::size_t segment_crossings = 3;
inline constexpr std::size_t segment_origin = 4;
inline constexpr std::size_t segment_previous_density = 7;
inline constexpr std::size_t segment_direction = 8;
inline constexpr std::size_t segment_eta_scale = 11;
inline constexpr std::size_t segment_throughput = 12;
inline constexpr std::size_t segment_medium = 15;
inline constexpr std::size_t segment_radiance = 16;
inline constexpr std::size_t segment_ray_length = 19;
inline constexpr std::size_t segment_previous_position = 20;
inline constexpr std::size_t segment_diffuse_count = 23;
inline constexpr std::size_t segment_glossy_count = 24;
inline constexpr std::size_t segment_specular_count = 25;

inline constexpr std::size_t ray_kind = 2;  ///< RayKind
inline constexpr std::size_t ray_dimension = 3;
inline constexpr std::size_t ray_origin = 4;
inline constexpr std::size_t ray_t_max = 7;
inline constexpr std::size_t ray_direction = 8;
inline constexpr std::size_t ray_answer = 11;  ///< TracedRay::answer
inline constexpr std::size_t hit_kind = 12;    ///< HitKind
inline constexpr std::size_t hit_instance = 13;
inline constexpr std::size_t hit_geometry = 14;
inline constexpr std::size_t hit_primitive = 15;
inline constexpr std::size_t hit_t = 28;             ///< not in the digest
inline constexpr std::size_t hit_barycentrics = 29;  ///< a pair, not in the digest

inline constexpr std::size_t surface_material = 2;
inline constexpr std::size_t surface_outside = 3;
inline constexpr std::size_t surface_position = 4;
inline constexpr std::size_t surface_offset = 7;
inline constexpr std::size_t surface_geometric_normal = 8;
inline constexpr std::size_t surface_shading_normal = 12;
inline constexpr std::size_t surface_texture_coordinates = 16;  ///< a pair

inline constexpr std::size_t medium_bits = 2;  ///< two words
inline constexpr std::size_t medium_weight = 4;
inline constexpr std::size_t medium_distance = 7;
inline constexpr std::size_t medium_scattered = 8;

inline constexpr std::size_t emission_environment = 2;
inline constexpr std::size_t emission_radiance = 4;
inline constexpr std::size_t emission_contribution = 8;

inline constexpr std::size_t light_sample_light = 2;
inline constexpr std::size_t light_sample_infinite = 3;
inline constexpr std::size_t light_sample_bits = 4;  ///< four words
inline constexpr std::size_t light_sample_direction = 8;
inline constexpr std::size_t light_sample_density = 11;
inline constexpr std::size_t light_sample_radiance = 12;
inline constexpr std::size_t light_sample_target = 16;

inline constexpr std::size_t light_value_bsdf = 4;
inline constexpr std::size_t light_value_bsdf_density = 7;
inline constexpr std::size_t light_value_weight = 11;

inline constexpr std::size_t visibility = 4;
inline constexpr std::size_t direct_light_contribution = 4;

inline constexpr std::size_t scatter_lobe = 2;
inline constexpr std::size_t scatter_leaves = 3;
inline constexpr std::size_t scatter_bits = 4;  ///< four words
inline constexpr std::size_t scatter_direction = 8;
inline constexpr std::size_t scatter_density = 11;
inline constexpr std::size_t scatter_weight = 12;
inline constexpr std::size_t scatter_eta = 15;
inline constexpr std::size_t scatter_model = 16;

inline constexpr std::size_t roulette_survives = 2;
inline constexpr std::size_t roulette_bits = 3;
inline constexpr std::size_t roulette_survival = 4;

inline constexpr std::size_t end_reason = 2;  ///< EndReason
inline constexpr std::size_t end_ray_count = 3;
inline constexpr std::size_t end_radiance = 4;

}  // namespace tandem::pathtracer::event_word
