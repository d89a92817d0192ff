#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <new>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "base/progress.hpp"
#include "compare/image/difference.hpp"
#include "pathtracer/image/image_io.hpp"
#include "tools/command.hpp"
#include "tools/options/comparison_options.hpp"
#include "tools/options/device_options.hpp"
#include "tools/options/job.hpp"
#include "tools/options/option_values.hpp"
#include "tools/options/shipped_file.hpp"
#include "tools/output/interruption.hpp"
#include "tools/output/output_file.hpp"
#include "tools/output/print.hpp"
#include "tools/output/progress_bar.hpp"
#include "tools/output/run_record.hpp"
#include "tools/report/device_json.hpp"
#include "tools/suite/gallery.hpp"

namespace tandem::tools {
namespace {

constexpr std::uint32_t largest_picture = 256;

struct Options {
  std::filesystem::path list = shipped_scene("gallery.json");
  std::filesystem::path folder = "gallery";
  std::string a = "cpu";          ///< the first device, the reference
  std::string b = "vulkan";       ///< the second
  std::vector<std::string> only;  ///< names; empty: all
  std::optional<glm::uvec2> size;
  std::optional<std::uint32_t> samples;  ///< in place of those of the list
  std::uint32_t threads = 0;
};

std::string names_of(const std::vector<GalleryScene>& scenes) {
  std::vector<std::string> names;
  for (const GalleryScene& scene : scenes) names.push_back(scene.name);
  return fmt::format("{}", fmt::join(names, ", "));
}

std::vector<GalleryScene> chosen_scenes(const Options& options) {
  std::vector<GalleryScene> scenes = read_gallery(options.list);
  for (const std::string& name : options.only)
    if (std::ranges::none_of(scenes, [&](const GalleryScene& scene) { return scene.name == name; }))
      throw Error(fmt::format("{} lists no scene '{}'; it lists {}", options.list.string(), name, names_of(scenes)));
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
  GalleryResult result{.scene = scene,
                       .comparison = compare_devices(devices, load_job(render_options),
                                                     comparison_options(arguments, render_options), progress_bars())};
  compare::Comparison& comparison = result.comparison;
  result.picture = reduced(comparison.a.image, largest_picture);
  result.difference = reduced(compare::heat_map(comparison.a.image, comparison.b.image), largest_picture);
  comparison.a.image = comparison.b.image = {};
  return result;
}

void print_line(const GalleryResult& result) {
  const compare::Comparison& comparison = result.comparison;
  print("{:<34}{:9.4f} % bit-equal  {}\n", result.scene.name, 100 * comparison.metrics.bit_equal,
        compare::name(comparison.verdict));
  for (const std::string& reason : comparison.verdict.reasons) print("{:<34}{}\n", "", reason);
  std::fflush(stdout);
}

/// Pictures first, so that a page never shows one that is not there.
std::vector<OutputFile> output_files(const Gallery& gallery, const std::filesystem::path& folder) {
  std::vector<OutputFile> files;
  for (const GalleryResult& result : gallery.results) {
    const auto add_picture = [&](const std::filesystem::path& path, const pathtracer::Image& image) {
      files.push_back(
          {folder / path, [&image](const std::filesystem::path& name) { pathtracer::write_image(name, image, {}); }});
    };
    add_picture(picture_path(result.scene), result.picture);
    add_picture(difference_path(result.scene), result.difference);
  }
  const auto add_text = [&](const char* name, const auto& text) {
    files.push_back({folder / name, [text](const std::filesystem::path& path) { write_text(path, text()); }});
  };
  add_text("gallery.json", [&gallery] { return json_text(to_json(gallery)); });
  add_text("gallery.md", [&gallery] { return gallery_markdown(gallery); });
  add_text("index.html", [&gallery] { return gallery_html(gallery); });
  return files;
}

int render_gallery(const Options& options) {
  const std::vector<GalleryScene> scenes = chosen_scenes(options);
  RenderOptions device_options;
  device_options.threads = options.threads;
  ComparisonArguments arguments;
  arguments.a = options.a;
  arguments.b = options.b;
  const compare::ComparedDevices devices = open_devices(arguments, device_options);
  Gallery gallery{.results = {}, .listed = scenes.size(), .date = date_text(), .command = command_line()};
  const OutputFolder folder(options.folder);
  const OutputFolder pictures((folder.path() / picture_path(scenes.front())).parent_path());
  check_output_files(output_files(gallery, folder.path()));
  // Nothing is written before the end, and then what was rendered, whole: pages and pictures belong together.
  const auto write_finished = [&](const char* what, const char* why) {
    if (gallery.results.empty()) return std::string(why);
    write_or_rescue(output_files(gallery, folder.path()));
    return fmt::format("{} after {} of {} scenes, which '{}' shows{}{}", what, gallery.results.size(), scenes.size(),
                       (folder.path() / "index.html").string(), *why == '\0' ? "" : ": ", why);
  };
  for (const GalleryScene& scene : scenes) {
    try {
      if (interrupted()) throw Cancelled();
      gallery.results.push_back(render_scene(scene, options, devices));
    } catch (const Cancelled& cancelled) {
      if (gallery.results.empty()) throw;
      throw Cancelled(write_finished("interrupted", ""));
    } catch (const std::bad_alloc&) {
      throw Error(write_finished("ended", "not enough memory for this scene and image size"));
    } catch (const std::exception& error) {
      throw Error(write_finished("ended", error.what()));
    }
    print_line(gallery.results.back());
  }
  const std::vector<OutputFile> files = output_files(gallery, folder.path());
  write_or_rescue(files);
  print_written(std::span(files).last(3));  // the pages
  return exit_code_of(outcome_of(gallery.results));
}

}  // namespace

void add_gallery_command(CLI::App& app, Action& action) {
  CLI::App* const command =
      app.add_subcommand("gallery", "Compare two devices on a list of scenes, in one page with images and verdicts");
  const auto options = std::make_shared<Options>();
  command->add_option("LIST", options->list, "The list of scenes")->type_name("FILE.json")->capture_default_str();
  command
      ->add_option("--out", options->folder, "Folder for index.html, gallery.md, gallery.json and images/gallery/*.png")
      ->type_name("DIR")
      ->capture_default_str();
  add_device_pair(*command, options->a, options->b);
  command->add_option("--only", options->only, "Render only these scenes")->delimiter(',')->type_name("NAME,...");
  add_size(*command, "--size", options->size, "Width and height in pixels [the scene file's, or else 512x512]");
  add_whole_number(*command, "--spp", options->samples, 1, 1U << 24, "Samples per pixel [those of the list]");
  add_whole_number(*command, "--threads", options->threads, 0, 1024,
                   "Worker threads of the CPU devices; 0: one per hardware thread");
  command->footer(
      "Exit code: 0 every scene agrees, 1 one differs beyond its thresholds, 2 error, 130 interrupted: the pages show "
      "what\nwas finished.\n"
      "Examples:\n"
      "  tandem gallery --out docs/results\n"
      "  tandem gallery --device cpu,vulkan:1 --size 256x256 --only veach_mis --out gallery");
  command->callback([&action, options] { action = [options] { return render_gallery(*options); }; });
}

}  // namespace tandem::tools
