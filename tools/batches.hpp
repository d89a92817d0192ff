#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>

#include "pathtracer/render/renderer.hpp"
#include "tools/rendering.hpp"
#include "tools/report/statistics_report.hpp"

/// Tier statistical: a scene rendered in batches under different seeds, so that the noise is known.
namespace tandem::tools {

struct BatchOptions {
  std::optional<std::uint32_t> batches;  ///< none: as many as samples per pixel, from 8 to 32
  std::uint32_t tile = 16;               ///< side in pixels
  std::optional<std::uint32_t> seed_b;   ///< of the first batch of b; none: one that a does not use
};

/// Declares the options on the command. `options` must outlive the parsing.
void add_batch_options(CLI::App& command, BatchOptions& options);

/// Renders the job in batches, twice on each device under different seeds, and tests a against b and each device
/// against itself. Throws Interrupted.
/// @param level p-values below this are a bias
/// @param rendering_a receives the mean of the first batches of a, with their times and rays; rendering_b likewise
Statistics compare_batches(pathtracer::Renderer& a, const rhi::DeviceInfo& device_a, pathtracer::Renderer& b,
                           const rhi::DeviceInfo& device_b, const RenderJob& job, const BatchOptions& options,
                           double level, Rendering& rendering_a, Rendering& rendering_b);

}  // namespace tandem::tools
