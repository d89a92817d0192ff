#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "base/progress.hpp"
#include "pathtracer/image/image.hpp"
#include "pathtracer/render/renderer.hpp"

namespace tandem::pathtracer {

/// A picture and what its noise can be told from, all of one size. Planes of width * height values.
struct NoisyPicture {
  Image radiance;  ///< mean of the samples
  /// Of that mean, channel by channel; below 0 where it is unknown.
  std::vector<glm::vec3> variance;
  /// Of the first hits of the picture's samples: mean albedo, 0 for samples that hit nothing, and emission, which is
  /// that of the background for these.
  std::vector<glm::vec3> sampled_albedo, sampled_emission;
  /// The same and the guides below of more first hits than samples, or of the same: what an edge shows comes from
  /// these.
  std::vector<glm::vec3> albedo, emission;
  std::vector<glm::vec3> normal;  ///< mean of the first hits, in world space, of any length
  std::vector<float> depth;       ///< mean distance of the first hits
  std::vector<float> coverage;    ///< fraction of the samples that hit anything
};

/// First hits that render_noisy_picture looks at for each sample: a path costs many times as much.
inline constexpr std::uint32_t guide_samples_per_sample = 32;

/// Renders `samples` (at least 1) into an empty picture and looks at the first hits of as many, and of
/// `guide_samples_per_sample` times as many.
///
/// The variance is that of the means of up to 16 batches of samples, over their number: the samples are taken a batch
/// at a time, which changes no bit of the picture. With less than two samples it is unknown. Samples of a sequence
/// (Sobol, Halton) are spread more evenly than independent ones, so theirs comes out too high.
/// @return nothing when `progress` cancelled
std::optional<NoisyPicture> render_noisy_picture(Renderer& renderer, std::uint32_t samples,
                                                 const Progress& progress = {});

}  // namespace tandem::pathtracer
