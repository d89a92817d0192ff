#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "compare/session/rendering.hpp"
#include "pathtracer/denoise/denoiser.hpp"
#include "pathtracer/image/image_io.hpp"
#include "pathtracer/render/first_hits.hpp"
#include "tools/command.hpp"
#include "tools/options/device_options.hpp"
#include "tools/options/job.hpp"
#include "tools/options/option_values.hpp"
#include "tools/options/render_options.hpp"
#include "tools/output/messages.hpp"
#include "tools/output/output_file.hpp"
#include "tools/output/print.hpp"
#include "tools/output/progress_bar.hpp"
#include "tools/report/speed.hpp"

namespace tandem::tools {
namespace {

struct Options {
  RenderOptions render;
  std::string device = "cpu";
  std::filesystem::path output;
  pathtracer::Tone tone;
  bool layers = false;  ///< what pixels show first, beside the picture
  bool denoises = false;
  pathtracer::DenoiseSettings denoise;
  /// Given on the command line; DenoiseSettings has the defaults.
  std::optional<std::uint32_t> denoise_levels;
  std::optional<double> denoise_strength, denoise_fireflies;
};

/// The denoiser's options as its settings. Throws Error for an option that has nothing to set.
pathtracer::DenoiseSettings denoise_settings(const Options& options) {
  const auto needs_denoising = [&](bool is_given, const char* option) {
    if (is_given && !options.denoises) throw Error(fmt::format("{} needs --denoise", option));
  };
  needs_denoising(options.denoise_levels.has_value(), "--denoise-levels");
  needs_denoising(options.denoise_strength.has_value(), "--denoise-strength");
  needs_denoising(options.denoise_fireflies.has_value(), "--denoise-fireflies");
  pathtracer::DenoiseSettings settings;
  if (options.denoise_levels) settings.levels = *options.denoise_levels;
  if (options.denoise_strength) settings.luminance_deviations = static_cast<float>(*options.denoise_strength);
  if (options.denoise_fireflies) settings.firefly_deviations = static_cast<float>(*options.denoise_fireflies);
  return settings;
}

/// Three channels of a layer.
void add_layer(std::vector<pathtracer::ImageChannel>& layers, const std::string& name,
               const std::vector<glm::vec3>& pixels) {
  constexpr const char* channels[] = {"R", "G", "B"};
  for (int c = 0; c < 3; ++c) {
    pathtracer::ImageChannel channel{.name = name + "." + channels[c], .is_integer = false, .words = {}};
    for (const glm::vec3& pixel : pixels) channel.words.push_back(std::bit_cast<std::uint32_t>(pixel[c]));
    layers.push_back(std::move(channel));
  }
}

/// Says so when most of a picture is brighter than it can show, and which exposure helps.
void note_clipping(const pathtracer::Image& image, const pathtracer::Tone& tone) {
  if (tone.curve != pathtracer::ToneCurve::srgb && tone.curve != pathtracer::ToneCurve::gamma) return;
  std::vector<float> brightest;
  for (const glm::vec3& pixel : image.pixels) brightest.push_back(std::max({pixel.x, pixel.y, pixel.z}));
  const double white = std::exp2(-tone.exposure);
  constexpr double margin = 1.01;  // a white background is not too bright
  const auto clipped = std::ranges::count_if(brightest, [&](float value) { return value > margin * white; });
  const double fraction =
      static_cast<double>(clipped) / static_cast<double>(std::max<std::size_t>(brightest.size(), 1));
  if (!(fraction > 0.5)) return;
  // Nine tenths of the pixels fit.
  const auto ninth = brightest.begin() + static_cast<std::ptrdiff_t>(0.9 * static_cast<double>(brightest.size() - 1));
  std::ranges::nth_element(brightest, ninth);
  if (!std::isfinite(*ninth)) return;
  print_note(fmt::format("{:.0f} % of the picture is brighter than white; --exposure {} shows it", 100 * fraction,
                         std::max(-100.0, -std::ceil(std::log2(double{*ninth})))));
}

int render_image(const Options& options) {
  pathtracer::check_image_path(options.output);
  if (options.layers && options.output.extension() != ".exr")
    throw Error(fmt::format("--aovs: '{}' is not an .exr; only .exr files hold AOVs", options.output.string()));
  const pathtracer::DenoiseSettings denoise = denoise_settings(options);
  const compare::Job job = load_job(options.render);
  const rhi::DeviceHandle device = open_device(options.device, options.render);
  std::optional<ShownStage> stage(building_stage);
  pathtracer::Renderer renderer(device, job.scene, job.settings, options.render.trace);
  stage.reset();
  std::optional<pathtracer::NoisyPicture> noisy;
  if (options.denoises) {
    const StageProgress progress = progress_bars();
    compare::compile(renderer, progress);
    noisy = pathtracer::render_noisy_picture(renderer, job.samples, stage_of(progress, device->info().name));
    if (!noisy) throw Cancelled();
  }
  // What a denoiser needs has been rendered by now.
  compare::Rendering rendering = compare::render(renderer, noisy ? 0 : job.samples, progress_bars());
  print_warnings(rendering.warnings);
  const auto is_finite = [](const glm::vec3& pixel) {
    return std::isfinite(pixel.x) && std::isfinite(pixel.y) && std::isfinite(pixel.z);
  };
  const std::size_t pixels = rendering.image.pixels.size();
  const auto finite = static_cast<std::size_t>(std::ranges::count_if(rendering.image.pixels, is_finite));
  if (finite < pixels)
    print_warnings({fmt::format("{} of {} pixels are not finite numbers (NaN or infinity)", pixels - finite, pixels)});
  if (noisy) {
    rendering.image = pathtracer::Denoiser(device).denoise(*noisy, denoise);
    rendering.metadata["denoiser"] = fmt::format("levels {} strength {} fireflies {}", denoise.levels,
                                                 denoise.luminance_deviations, denoise.firefly_deviations);
  }
  if (options.output.extension() == ".png") note_clipping(rendering.image, options.tone);
  std::vector<pathtracer::ImageChannel> layers;
  if (options.layers) layers = pathtracer::first_hits(renderer.scene(), job.samples);
  if (noisy && options.output.extension() == ".exr") {
    add_layer(layers, "noisy", noisy->radiance.pixels);
    add_layer(layers, "variance", noisy->variance);
  }
  const OutputFile file{options.output, [&](const std::filesystem::path& path) {
                          pathtracer::write_image(path, rendering.image, rendering.metadata, options.tone, layers);
                        }};
  write_or_rescue({&file, 1});
  print("{}: {}x{}, {} spp on {} ({}, {}) in {:.1f} ms, {:.3f} Mrays/s\n", options.output.string(), job.settings.width,
        job.settings.height, job.samples, rendering.device.name, rendering.device.description,
        pathtracer::name(rendering.trace), rendering.milliseconds,
        per_second_in_millions(static_cast<double>(rendering.rays), rendering.milliseconds));
  constexpr double worth_mentioning = 1000;
  if (rendering.compile_milliseconds > worth_mentioning)
    print("shaders for {} compiled in {:.1f} s\n", rendering.device.name, rendering.compile_milliseconds / 1000);
  return exit_code::success;
}

}  // namespace

void add_render_command(CLI::App& app, Action& action) {
  CLI::App* const command = app.add_subcommand("render", "Render a scene on one device into an image file");
  const auto options = std::make_shared<Options>();
  add_render_options(*command, options->render);
  command->add_option("-o,--output", options->output, "Image file: .exr (linear, 32-bit float) or .png (8 bits)")
      ->required()
      ->type_name("FILE");
  command->add_flag(
      "--aovs,--layers", options->layers,
      "Add first-hit AOVs to the .exr: albedo, emission, normal, depth, coverage, primitive and material ids");
  command->add_flag("--denoise", options->denoises,
                    "Filter noise out of the picture; an .exr keeps what it was as layer 'noisy', with its variance");
  add_whole_number(*command, "--denoise-levels", options->denoise_levels, 0, 10,
                   "Levels of the filter: the last one looks 2^N pixels far (default 5)");
  add_number(*command, "--denoise-strength", options->denoise_strength, 0.01, 1000,
             "Standard errors of a pixel that count as noise (default 3)");
  add_number(*command, "--denoise-fireflies", options->denoise_fireflies, 0, 1e6,
             "Standard deviations above its neighbourhood that make a pixel a firefly (default 2); 0: none is");
  add_tone_options(*command, options->tone);
  add_device(*command, options->device, "Device to render on, as listed by 'tandem devices'",
             "'tandem diff' compares two");
  command->footer(
      "Examples:\n"
      "  tandem render scenes/cornell_box.obj -o box.png\n"
      "  tandem render scenes/cornell_spheres.obj --device vulkan --size 1280x720 --spp 256 -o spheres.exr\n"
      "  tandem render scenes/cornell_box.obj --denoise -o clean.exr\n"
      "  tandem render model.obj --camera-position 0,1,5 --camera-target 0,1,0 --fov 35 -o model.png");
  command->callback([&action, options] { action = [options] { return render_image(*options); }; });
}

}  // namespace tandem::tools
