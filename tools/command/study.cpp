#include <fmt/format.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "base/progress.hpp"
#include "compare/study/sampling_study.hpp"
#include "compare/study/study_scenes.hpp"
#include "tools/command.hpp"
#include "tools/options/option_values.hpp"
#include "tools/options/study_options.hpp"
#include "tools/output/progress_bar.hpp"
#include "tools/report/device_json.hpp"
#include "tools/report/study_report.hpp"

namespace tandem::tools {
namespace {

struct Options {
  StudyOptions study;
  study::StudySettings settings;
};

int study_sampling(const Options& options) {
  const rhi::DeviceHandle device = open_study_device(options.study);
  StudyReport report{.device = device->info(), .settings = options.settings, .scenes = {}};
  struct Subject {
    pathtracer::Scene scene;
    bool compares_thesis;
  };
  for (const Subject& subject : {Subject{study::weekend_box(), true}, Subject{study::veach_plates(), false},
                                 Subject{study::light_over_floor(), false}}) {
    std::optional<study::SceneResult> result =
        study::study_scene(device, subject.scene, study::methods(), options.settings, subject.compares_thesis,
                           progress_bar(subject.scene.name));
    if (!result) throw Cancelled();
    report.scenes.push_back(std::move(*result));
  }
  finish_study(options.study, {.markdown = markdown(report), .json = json_text(to_json(report)), .page = {}});
  return exit_code::success;
}

}  // namespace

void add_study_command(CLI::App& app, Action& action) {
  CLI::App* const group = app.add_subcommand("study", "Measure the efficiency of Monte Carlo methods");
  group->require_subcommand(1);
  CLI::App* const command = group->add_subcommand(
      "sampling", "Error, variance, time and order of convergence of every sampler and integrator option");
  const auto options = std::make_shared<Options>();
  add_study_options(*command, options->study);
  add_whole_number(*command, "--size", options->settings.size, 1, 4096,
                   "Width and height of the square images, in pixels");
  add_whole_number(*command, "--reference-spp", options->settings.reference_samples, 1, 1u << 24,
                   "Samples per pixel of the reference image");
  command->footer(
      "The scenes are built in: the Cornell box of Ray Tracing in One Weekend's series, Veach's plates, and a light "
      "over\n"
      "a floor, whose integrand is smooth. RMSE is over pixels and channels, V is the variance of one sample, T the\n"
      "time on the device in seconds; the efficiency 1 / (V T) is relative to that of the first method.\n"
      "Example:\n"
      "  tandem study sampling --device cpu --markdown sampling.md");
  command->callback([&action, options] { action = [options] { return study_sampling(*options); }; });
  add_study_markov_command(*group, action);
  add_study_metropolis_command(*group, action);
  add_study_denoising_command(*group, action);
}

}  // namespace tandem::tools
