#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/progress.hpp"
#include "compare/study/random_walk_study.hpp"
#include "tools/command.hpp"
#include "tools/options/option_values.hpp"
#include "tools/options/study_options.hpp"
#include "tools/output/progress_bar.hpp"
#include "tools/report/device_json.hpp"
#include "tools/report/markov_report.hpp"

namespace tandem::tools {
namespace {

struct Options {
  StudyOptions study;
  study::RandomWalkSettings settings;
  std::uint32_t most_walks = 65536;
};

int study_markov(const Options& options) {
  const rhi::DeviceHandle device = open_study_device(options.study);
  study::RandomWalkSettings settings = options.settings;
  settings.walk_counts = study::walk_counts_up_to(options.most_walks);
  std::optional<std::vector<study::FredholmResult>> equations =
      study::study_random_walks(device, settings, progress_bar("random walks"));
  if (!equations) throw Cancelled();
  const MarkovReport report{.device = device->info(), .settings = settings, .equations = std::move(*equations)};
  finish_study(options.study,
               {.markdown = markdown(report), .json = json_text(to_json(report)), .page = plots_page(report)});
  return exit_code::success;
}

}  // namespace

void add_study_markov_command(CLI::App& group, Action& action) {
  CLI::App* const command = group.add_subcommand(
      "markov", "Integral equations solved by random walks: error, variance, time and order of convergence");
  const auto options = std::make_shared<Options>();
  add_study_options(*command, options->study);
  add_whole_number(*command, "--walks", options->most_walks, 256, 1u << 22,
                   "Walks from each point at most; the study begins with 64 and takes four times as many each time");
  add_number(*command, "--absorption", options->settings.walks.absorption, 0.1, 0.7,
             "Probability that a walk is absorbed at a state; beyond 0.7 some variances would be infinite");
  add_whole_number(*command, "--length", options->settings.walks.length, 1, 1000,
                   "Steps of the walks of fixed length, which leave out the rest of the Neumann series");
  add_whole_number(*command, "--seed", options->settings.walks.seed, 0, 0xffffffffu, "Seed of the random numbers");
  command->add_option("--html", options->study.page, "Write a page with a plot for each equation")->type_name("FILE");
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
