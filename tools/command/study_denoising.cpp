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
#include "tools/options/device_options.hpp"
#include "tools/options/job.hpp"
#include "tools/options/option_values.hpp"
#include "tools/options/shipped_file.hpp"
#include "tools/output/interruption.hpp"
#include "tools/output/output_file.hpp"
#include "tools/output/print.hpp"
#include "tools/output/progress_bar.hpp"
#include "tools/report/denoising_report.hpp"
#include "tools/report/device_json.hpp"

namespace tandem::tools {
namespace {

struct Options {
  std::vector<std::filesystem::path> scenes;  ///< empty: the shipped ones
  std::string device = "cpu";
  std::uint32_t threads = 0;
  study::DenoisingSettings settings;
  std::filesystem::path json;      ///< empty: none
  std::filesystem::path markdown;  ///< likewise
};

/// Diffuse boxes, and where the filter has less to go by: mirrors and glass, fine textures.
constexpr const char* shipped[] = {"cornell_box.obj",    "cornell_box_white.json", "cornell_box_saturated.json",
                                   "cornell_blocks.obj", "cornell_spheres.obj",    "still_life_outdoors.json"};

int study_denoising(const Options& options) {
  for (const std::filesystem::path& path : {options.json, options.markdown})
    if (!path.empty()) check_output_path(path);
  std::vector<std::filesystem::path> files = options.scenes;
  if (files.empty())
    for (const char* name : shipped) files.push_back(shipped_scene(name));
  std::vector<pathtracer::Scene> scenes;
  for (const std::filesystem::path& file : files) scenes.push_back(pathtracer::load_scene(file));
  RenderOptions device_options;
  device_options.threads = options.threads;
  const rhi::DeviceHandle device = open_device(options.device, device_options);
  DenoisingReport report{.device = device->info(), .settings = options.settings, .scenes = {}};
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    std::optional<study::DenoisedScene> result =
        study::study_denoising(device, scenes[i], options.settings, progress_bar(files[i].stem().string()));
    if (!result) throw Cancelled();
    result->scene = files[i].filename().string();
    report.scenes.push_back(std::move(*result));
  }
  print("{}", markdown(report));
  std::vector<OutputFile> outputs;
  if (!options.json.empty())
    outputs.push_back(
        {options.json, [&](const std::filesystem::path& path) { write_text(path, json_text(to_json(report))); }});
  if (!options.markdown.empty())
    outputs.push_back(
        {options.markdown, [&](const std::filesystem::path& path) { write_text(path, markdown(report)); }});
  write_or_rescue(outputs);
  print_written(outputs);
  return exit_code::success;
}

}  // namespace

void add_study_denoising_command(CLI::App& study, Action& action) {
  CLI::App* const command =
      study.add_subcommand("denoising", "Error of noisy and of denoised pictures against pictures of many samples");
  const auto options = std::make_shared<Options>();
  command->add_option("SCENE", options->scenes, "Scene files; without any, six of the shipped ones")->type_name("FILE");
  add_device(*command, options->device, "Device to render on, as listed by 'tandem devices'",
             "run the study once for each");
  add_whole_number(*command, "--threads", options->threads, 0, 4096,
                   "Worker threads of the CPU devices; 0: one per hardware thread");
  add_whole_number(*command, "--size", options->settings.size, 1, 4096,
                   "Width and height of the square images, in pixels");
  add_whole_number(*command, "--spp", options->settings.samples, 1, 1u << 20, "Samples per pixel of the noisy image");
  add_whole_number(*command, "--reference-spp", options->settings.reference_samples, 1, 1u << 24,
                   "Samples per pixel of the reference image");
  command->add_option("--json", options->json, "Write all measurements as JSON")->type_name("FILE");
  command->add_option("--markdown", options->markdown, "Write the table as Markdown")->type_name("FILE");
  command->footer(
      "Example:\n"
      "  tandem study denoising --device cpu --markdown denoising.md");
  command->callback([&action, options] { action = [options] { return study_denoising(*options); }; });
}

}  // namespace tandem::tools
