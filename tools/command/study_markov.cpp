#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/progress.hpp"
#include "compare/study/random_walk_study.hpp"
#include "tools/command.hpp"
#include "tools/options/device_options.hpp"
#include "tools/options/job.hpp"
#include "tools/options/option_values.hpp"
#include "tools/output/output_file.hpp"
#include "tools/output/print.hpp"
#include "tools/output/progress_bar.hpp"
#include "tools/report/device_json.hpp"
#include "tools/report/markov_report.hpp"

namespace tandem::tools {
namespace {

struct Options {
  std::string device = "cpu";
  std::uint32_t threads = 0;
  study::RandomWalkSettings settings;
  std::uint32_t most_walks = 65536;
  std::filesystem::path json;      ///< empty: none
  std::filesystem::path markdown;  ///< likewise
  std::filesystem::path page;      ///< likewise
};

int study_markov(const Options& options) {
  for (const std::filesystem::path& path : {options.json, options.markdown, options.page})
    if (!path.empty()) check_output_path(path);
  RenderOptions device_options;
  device_options.threads = options.threads;
  const rhi::DeviceHandle device = open_device(options.device, device_options);
  study::RandomWalkSettings settings = options.settings;
  settings.walk_counts = study::walk_counts_up_to(options.most_walks);
  std::optional<std::vector<study::FredholmResult>> equations =
      study::study_random_walks(device, settings, progress_bar("random walks"));
  if (!equations) throw Cancelled();
  const MarkovReport report{.device = device->info(), .settings = settings, .equations = std::move(*equations)};
  print("{}", markdown(report));
  std::vector<OutputFile> files;
  if (!options.json.empty())
    files.push_back(
        {options.json, [&](const std::filesystem::path& path) { write_text(path, json_text(to_json(report))); }});
  if (!options.markdown.empty())
    files.push_back({options.markdown, [&](const std::filesystem::path& path) { write_text(path, markdown(report)); }});
  if (!options.page.empty())
    files.push_back({options.page, [&](const std::filesystem::path& path) { write_text(path, plots_page(report)); }});
  write_or_rescue(files);
  print_written(files);
  return exit_code::success;
}

}  // namespace

void add_study_markov_command(CLI::App& group, Action& action) {
  CLI::App* const command = group.add_subcommand(
      "markov", "Integral equations solved by random walks: error, variance, time and order of convergence");
  const auto options = std::make_shared<Options>();
  add_device(*command, options->device, "Device to run on, as listed by 'tandem devices'",
             "run the study once for each");
  add_whole_number(*command, "--threads", options->threads, 0, 4096,
                   "Worker threads of the CPU devices; 0: one per hardware thread");
  add_whole_number(*command, "--walks", options->most_walks, 256, 1u << 22,
                   "Walks from each point at most; the study begins with 64 and takes four times as many each time");
  add_number(*command, "--absorption", options->settings.walks.absorption, 0.1, 0.7,
             "Probability that a walk is absorbed at a state; beyond 0.7 some variances would be infinite");
  add_whole_number(*command, "--length", options->settings.walks.length, 1, 1000,
                   "Steps of the walks of fixed length, which leave out the rest of the Neumann series");
  add_whole_number(*command, "--seed", options->settings.walks.seed, 0, 0xffffffffu, "Seed of the random numbers");
  command->add_option("--json", options->json, "Write all measurements as JSON")->type_name("FILE");
  command->add_option("--markdown", options->markdown, "Write the tables as Markdown")->type_name("FILE");
  command->add_option("--html", options->page, "Write a page with a plot for each equation")->type_name("FILE");
  command->footer(
      "The equations are u(x) = f(x) + integral of k(x, t) u(t) dt over [0, 1], Fredholm's of the second kind, with "
      "the\n"
      "solution e^x. RMSE is over the points, V is the variance of one walk, (V/N)^1/2 the error that it predicts, z "
      "an\n"
      "error over its standard error; the efficiency 1 / (V T) is relative to that of the first estimator.\n"
      "Example:\n"
      "  tandem study markov --device cpu --markdown markov.md");
  command->callback([&action, options] { action = [options] { return study_markov(*options); }; });
}

}  // namespace tandem::tools
