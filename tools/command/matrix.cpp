#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "compare/session/rendering.hpp"
#include "tools/command.hpp"
#include "tools/options/device_options.hpp"
#include "tools/options/job.hpp"
#include "tools/options/threshold_options.hpp"
#include "tools/output/messages.hpp"
#include "tools/output/output_file.hpp"
#include "tools/output/print.hpp"
#include "tools/output/progress_bar.hpp"
#include "tools/report/device_json.hpp"
#include "tools/report/matrix_report.hpp"

namespace tandem::tools {
namespace {

struct Options {
  RenderOptions render;
  ThresholdOptions thresholds;
  std::vector<std::string> devices;
  std::filesystem::path json;  ///< empty: none
};

int compare_matrix(const Options& options) {
  if (options.devices.size() < 3)
    throw Error("--device: a vote needs at least three devices; 'tandem diff' compares two");
  const compare::Job job = load_job(options.render);
  compare::Thresholds thresholds = compare::thresholds_of(options.render.scene, {});
  apply(options.thresholds, thresholds);
  if (thresholds.tier == compare::Tier::statistical)
    throw Error(fmt::format("{}: tier statistical is for 'tandem diff' only; a matrix compares equal samples",
                            options.render.scene.string()));
  if (!options.json.empty()) check_output_path(options.json);
  std::vector<rhi::DeviceHandle> devices;
  // All before the first rendering, so that what one of them refuses does not cost any.
  std::vector<std::unique_ptr<pathtracer::Renderer>> renderers;
  for (const std::string& name : options.devices) {
    devices.push_back(open_device(name, options.render));
    const ShownStage stage(building_stage);
    renderers.push_back(
        std::make_unique<pathtracer::Renderer>(devices.back(), job.scene, job.settings, options.render.trace));
  }
  std::vector<compare::Rendering> renderings;
  for (std::size_t index = 0; index < devices.size(); ++index)
    renderings.push_back(compare::render(*renderers[index], job.samples, progress_bars()));
  print_warnings(renderings.front().warnings);
  const MatrixReport report = compare_all(summary(job), thresholds, std::move(renderings));
  print("{}", table(report));
  if (!options.json.empty()) {
    const OutputFile file{options.json,
                          [&](const std::filesystem::path& path) { write_text(path, json_text(to_json(report))); }};
    write_or_rescue({&file, 1});
    print_written({&file, 1});
  }
  return report.agree() ? exit_code::success : exit_code::differ;
}

}  // namespace

void add_matrix_command(CLI::App& app, Action& action) {
  CLI::App* const command =
      app.add_subcommand("matrix", "Compare three or more devices in pairs, and by majority vote on each pixel");
  const auto options = std::make_shared<Options>();
  add_render_options(*command, options->render);
  add_devices(*command, options->devices, "Three or more devices")->required();
  command->add_option("--json", options->json, "Write all numbers as JSON")->type_name("FILE");
  add_threshold_options(*command, options->thresholds);
  command->footer(
      "A device is outvoted at a pixel where more than half of all devices agree, by bits or else within 1e-3 "
      "relative,\n"
      "and it does not agree with them.\n"
      "Exit code: 0 every pair agrees, 1 a pair differs, 2 error.\n"
      "Example:\n"
      "  tandem matrix scenes/cornell_box.obj --size 64x64 --device cpu,cpu-exact,vulkan");
  command->callback([&action, options] { action = [options] { return compare_matrix(*options); }; });
}

}  // namespace tandem::tools
