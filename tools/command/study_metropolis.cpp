#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <memory>
#include <optional>
#include <string>

#include "base/error.hpp"
#include "base/progress.hpp"
#include "compare/study/metropolis_study.hpp"
#include "tools/command.hpp"
#include "tools/options/device_options.hpp"
#include "tools/options/job.hpp"
#include "tools/options/option_values.hpp"
#include "tools/options/render_options.hpp"
#include "tools/output/output_file.hpp"
#include "tools/output/print.hpp"
#include "tools/output/progress_bar.hpp"

namespace tandem::tools {
namespace {

struct Options {
  RenderOptions render;
  std::string device = "cpu";
  study::MetropolisStudySettings settings;
  std::filesystem::path markdown;  ///< empty: none
};

void add_rows(std::string& text, const char* name, const study::IntegratorResult& result) {
  for (const study::Measurement& measurement : result.measurements)
    fmt::format_to(std::back_inserter(text), "| {:<10} | {:>7} | {:>8.2f} | {:>9.5f} |\n", name, measurement.samples,
                   measurement.seconds, measurement.rmse);
}

std::string markdown(const rhi::DeviceInfo& device, const compare::Job& job,
                     const study::MetropolisStudySettings& settings, const study::MetropolisResult& result) {
  std::string text = fmt::format(
      "Measured on {} ({}) by `tandem study metropolis {}`: {}x{} pixels, depth {}, errors between {} pictures under "
      "different seeds.\n\n| integrator | samples |  seconds |      RMSE |\n|------------|--------:|---------:|"
      "----------:|\n",
      device.name, device.description, job.file.string(), job.settings.width, job.settings.height,
      job.settings.max_depth, settings.pictures);
  add_rows(text, "path", result.path);
  add_rows(text, "metropolis", result.metropolis);
  const study::Measurement& last = result.metropolis.measurements.back();
  fmt::format_to(
      std::back_inserter(text),
      "\nIn {:.2f} seconds path tracing has an RMSE of {:.5f} (by N^-1/2 from its last row): {:.2f} times "
      "that of Metropolis. That chance alone makes their means differ as they do has a probability of {:.2g}.\n",
      last.seconds, result.path.error_after(last.seconds), result.error_ratio(), result.bias_p_value);
  return text;
}

int study_metropolis(const Options& options) {
  if (!options.markdown.empty()) check_output_path(options.markdown);
  compare::Job job = load_job(options.render);
  if (job.settings.integrator != pathtracer::Integrator::path &&
      job.settings.integrator != pathtracer::Integrator::metropolis)
    throw Error("--integrator: the study compares path and metropolis");
  job.settings.integrator = pathtracer::Integrator::metropolis;
  study::MetropolisStudySettings settings = options.settings;
  settings.sample_counts.clear();
  for (std::uint32_t count = std::max(job.samples / 16, 1u); count < job.samples; count *= 4)
    settings.sample_counts.push_back(count);
  settings.sample_counts.push_back(job.samples);
  const rhi::DeviceHandle device = open_device(options.device, options.render);
  pathtracer::Renderer renderer(device, job.scene, job.settings, options.render.trace);
  const std::optional<study::MetropolisResult> result =
      study::study_metropolis(renderer, settings, progress_bar(job.scene.name));
  if (!result) throw Cancelled();
  const std::string text = markdown(device->info(), job, settings, *result);
  print("{}", text);
  if (options.markdown.empty()) return exit_code::success;
  const OutputFile file{options.markdown, [&](const std::filesystem::path& path) { write_text(path, text); }};
  write_or_rescue({&file, 1});
  print_written({&file, 1});
  return exit_code::success;
}

}  // namespace

void add_study_metropolis_command(CLI::App& group, Action& action) {
  CLI::App* const command =
      group.add_subcommand("metropolis", "The error of Metropolis light transport against that of path tracing");
  const auto options = std::make_shared<Options>();
  add_render_options(*command, options->render);
  add_device(*command, options->device, "Device to render on, as listed by 'tandem devices'",
             "run the study once for each");
  add_whole_number(*command, "--pictures", options->settings.pictures, 2, 1000,
                   "Pictures under different seeds, from whose spread an error is known");
  command->add_option("--markdown", options->markdown, "Write the table as Markdown")->type_name("FILE");
  command->footer(
      "Both integrators render with --spp samples per pixel, and with 4 and 16 times fewer.\n"
      "Example:\n"
      "  tandem study metropolis scenes/door.json --spp 64");
  command->callback([&action, options] { action = [options] { return study_metropolis(*options); }; });
}

}  // namespace tandem::tools
