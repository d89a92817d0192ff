#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "base/progress.hpp"
#include "compare/session/job.hpp"
#include "compare/session/rendering.hpp"
#include "compare/statistics/bias_test.hpp"
#include "compare/verdict/verdict.hpp"
#include "pathtracer/render/renderer.hpp"

/// Tier statistical: a scene rendered in batches under different seeds, so that the noise is known.
namespace tandem::compare {

/// Fewer batches hardly know their noise; the mean over a smaller tile is not nearly normal: pixels of an edge are
/// black or white in a batch of one sample, and the mean of four of them is near enough.
inline constexpr std::uint32_t fewest_batches = 8;
inline constexpr std::uint32_t smallest_tile = 4;

struct BatchOptions {
  std::optional<std::uint32_t> batches;  ///< none: as many as samples per pixel, from 8 to 32
  std::uint32_t tile = 16;               ///< side in pixels
  std::optional<std::uint32_t> seed_b;   ///< of the first batch of b; none: one that a does not use
};

/// What tier statistical found out.
struct Statistics {
  double level = 0;  ///< p-values below this are a bias
  std::uint32_t batches = 0;
  std::uint32_t batch_samples = 0;  ///< per pixel
  std::uint32_t tile = 0;           ///< side in pixels
  /// Seeds of the first batches; the others follow.
  std::uint32_t seed_a = 0, control_seed_a = 0, seed_b = 0, control_seed_b = 0;
  BiasTest bias = {};       ///< a against b
  BiasTest control_a = {};  ///< a against itself under other seeds: the noise floor
  BiasTest control_b = {};  ///< b likewise
  BiasPower power = {};     ///< of the test of a against b
};

/// What a verdict asks for.
std::vector<BiasFinding> bias_findings(const Statistics& statistics);

/// Renders the job in batches, twice on each device under different seeds, and tests a against b and each device
/// against itself. Throws Cancelled.
/// @param level p-values below this are a bias
/// @param rendering_a receives the mean of the first batches of a, with their times and rays; rendering_b likewise
Statistics compare_batches(pathtracer::Renderer& a, pathtracer::Renderer& b, const Job& job,
                           const BatchOptions& options, double level, Rendering& rendering_a, Rendering& rendering_b,
                           const StageProgress& progress = {});

}  // namespace tandem::compare
