#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "compare/image/difference.hpp"
#include "pathtracer/image/image_io.hpp"
#include "tools/command.hpp"
#include "tools/options/comparison_options.hpp"
#include "tools/options/job.hpp"
#include "tools/options/option_values.hpp"
#include "tools/output/output_file.hpp"
#include "tools/output/print.hpp"
#include "tools/output/progress_bar.hpp"
#include "tools/report/device_json.hpp"
#include "tools/suite/gallery.hpp"

namespace tandem::tools {
namespace {

constexpr std::uint32_t largest_picture = 256;
const char* const pictures_folder = "images/gallery";

struct Options {
  std::filesystem::path list = "scenes/gallery.json";
  std::filesystem::path folder = "gallery";
  std::vector<std::string> devices = {"cpu", "vulkan"};
  std::vector<std::string> only;  ///< names; empty: all
  std::optional<glm::uvec2> size;
  std::optional<std::uint32_t> samples;  ///< in place of those of the list
  std::uint32_t threads = 0;
};

std::vector<GalleryScene> chosen_scenes(const Options& options) {
  std::vector<GalleryScene> scenes = read_gallery(options.list);
  for (const std::string& name : options.only)
    if (std::ranges::none_of(scenes, [&](const GalleryScene& scene) { return scene.name == name; }))
      throw Error(fmt::format("{} lists no scene '{}'", options.list.string(), name));
  if (!options.only.empty())
    std::erase_if(scenes, [&](const GalleryScene& scene) { return std::ranges::count(options.only, scene.name) == 0; });
  return scenes;
}

GalleryResult render_scene(const GalleryScene& scene, const Options& options, const compare::ComparedDevices& devices) {
  RenderOptions render_options;
  render_options.scene = scene.file;
  render_options.size = options.size;
  render_options.settings.samples = options.samples.value_or(scene.samples);
  ComparisonArguments arguments;
  arguments.comparison.thresholds = gallery_thresholds();
  return {.scene = scene,
          .comparison = compare_devices(devices, load_job(render_options),
                                        comparison_options(arguments, render_options), progress_bars())};
}

int render_gallery(const Options& options) {
  const std::vector<GalleryScene> scenes = chosen_scenes(options);
  RenderOptions device_options;
  device_options.threads = options.threads;
  ComparisonArguments arguments;
  arguments.a = options.devices.at(0);
  arguments.b = options.devices.at(1);
  const compare::ComparedDevices devices = open_devices(arguments, device_options);
  const OutputFolder folder(options.folder);
  const OutputFolder pictures(options.folder / pictures_folder);
  std::vector<GalleryResult> results;
  for (const GalleryScene& scene : scenes) {
    GalleryResult result = render_scene(scene, options, devices);
    compare::Comparison& comparison = result.comparison;
    const auto write = [&](const std::string& name, const pathtracer::Image& image) {
      pathtracer::write_image(pictures.path() / name, reduced(image, largest_picture), {});
    };
    write(scene.name + ".png", comparison.a.image);
    write(scene.name + "_difference.png", compare::heat_map(comparison.a.image, comparison.b.image));
    comparison.a.image = comparison.b.image = {};
    print("{:<34}{:9.4f} % bit-equal  {}\n", scene.name, 100 * comparison.metrics.bit_equal,
          compare::name(comparison.verdict));
    for (const std::string& reason : comparison.verdict.reasons) print("{:<34}{}\n", "", reason);
    std::fflush(stdout);
    results.push_back(std::move(result));
  }
  write_text(folder.path() / "gallery.md", gallery_markdown(results, pictures_folder));
  write_text(folder.path() / "gallery.json", json_text(to_json(results)));
  return exit_code_of(outcome_of(results));
}

}  // namespace

void add_gallery_command(CLI::App& app, Action& action) {
  CLI::App* const command =
      app.add_subcommand("gallery", "Compare two devices on a list of scenes, in one page with images and verdicts");
  const auto options = std::make_shared<Options>();
  command->add_option("LIST", options->list, "The list of scenes")->type_name("FILE.json")->capture_default_str();
  command->add_option("--out", options->folder, "Folder for gallery.md, gallery.json and images/gallery/*.png")
      ->type_name("DIR")
      ->capture_default_str();
  command->add_option("--device", options->devices, "The two devices; the first is the reference")
      ->expected(2)
      ->type_name("A B")
      ->capture_default_str();
  command->add_option("--only", options->only, "Render only these scenes")->type_name("NAME");
  add_size(*command, "--size", options->size, "Width and height in pixels [the scene file's, or else 512x512]");
  add_whole_number(*command, "--spp", options->samples, 1, 1U << 24, "Samples per pixel [those of the list]");
  add_whole_number(*command, "--threads", options->threads, 0, 1024,
                   "Worker threads of the CPU devices; 0: one per hardware thread");
  command->footer(
      "Exit code: 0 every scene agrees, 1 one differs beyond its thresholds, 2 error.\n"
      "Examples:\n"
      "  tandem gallery --out docs/results\n"
      "  tandem gallery --device cpu vulkan:1 --size 256x256 --only veach_mis --out gallery");
  command->callback([&action, options] { action = [options] { return render_gallery(*options); }; });
}

}  // namespace tandem::tools
