#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/progress.hpp"
#include "compare/study/denoising_study.hpp"
#include "pathtracer/load/scene_loader.hpp"
#include "tools/command.hpp"
#include "tools/options/option_values.hpp"
#include "tools/options/shipped_file.hpp"
#include "tools/options/study_options.hpp"
#include "tools/output/progress_bar.hpp"
#include "tools/report/denoising_report.hpp"
#include "tools/report/device_json.hpp"

namespace tandem::tools {
namespace {

struct Options {
  std::vector<std::filesystem::path> scenes;  ///< empty: the shipped ones
  StudyOptions study;
  study::DenoisingSettings settings;
};

/// Diffuse boxes, and where the filter has less to go by: mirrors and glass, fine textures.
constexpr const char* shipped[] = {"cornell_box.obj",    "cornell_box_white.json", "cornell_box_saturated.json",
                                   "cornell_blocks.obj", "cornell_spheres.obj",    "still_life_outdoors.json"};

int study_denoising(const Options& options) {
  std::vector<std::filesystem::path> files = options.scenes;
  if (files.empty())
    for (const char* name : shipped) files.push_back(shipped_scene(name));
  std::vector<pathtracer::Scene> scenes;
  for (const std::filesystem::path& file : files) scenes.push_back(pathtracer::load_scene(file));
  const rhi::DeviceHandle device = open_study_device(options.study);
  DenoisingReport report{.device = device->info(), .settings = options.settings, .scenes = {}};
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    std::optional<study::DenoisedScene> result =
        study::study_denoising(device, scenes[i], options.settings, progress_bar(files[i].stem().string()));
    if (!result) throw Cancelled();
    result->scene = files[i].filename().string();
    report.scenes.push_back(std::move(*result));
  }
  finish_study(options.study, {.markdown = markdown(report), .json = json_text(to_json(report)), .page = {}});
  return exit_code::success;
}

}  // namespace

void add_study_denoising_command(CLI::App& study, Action& action) {
  CLI::App* const command =
      study.add_subcommand("denoising", "Error of noisy and of denoised pictures against pictures of many samples");
  const auto options = std::make_shared<Options>();
  command->add_option("SCENE", options->scenes, "Scene files; without any, six of the shipped ones")->type_name("FILE");
  add_study_options(*command, options->study);
  add_whole_number(*command, "--size", options->settings.size, 1, 4096,
                   "Width and height of the square images, in pixels");
  add_whole_number(*command, "--spp", options->settings.samples, 1, 1u << 20, "Samples per pixel of the noisy image");
  add_whole_number(*command, "--reference-spp", options->settings.reference_samples, 1, 1u << 24,
                   "Samples per pixel of the reference image");
  command->footer(
      "Example:\n"
      "  tandem study denoising --device cpu --markdown denoising.md");
  command->callback([&action, options] { action = [options] { return study_denoising(*options); }; });
}

}  // namespace tandem::tools
