#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "compare/difference.hpp"
#include "pathtracer/image_io.hpp"
#include "tools/command.hpp"
#include "tools/device_json.hpp"
#include "tools/diff_report.hpp"
#include "tools/messages.hpp"
#include "tools/option_values.hpp"
#include "tools/output_file.hpp"
#include "tools/rendering.hpp"

namespace tandem::tools {
namespace {

struct Options {
  RenderOptions render;
  std::string a = "cpu";
  std::string b = "vulkan";
  std::string arbiter;  ///< empty: nobody is asked
  std::uint64_t arbiter_pixels = 1000;
  std::optional<pathtracer::TraceForm> trace_a;  ///< none: that of `render`
  std::optional<pathtracer::TraceForm> trace_b;
  std::filesystem::path json;    ///< empty: none
  std::filesystem::path folder;  ///< empty: no images
  compare::Tolerance tolerance;
  pathtracer::Tone tone;
};

/// What is written once the report is complete; it refers to both.
std::vector<OutputFile> output_files(const Options& options, const DiffReport& report) {
  std::vector<OutputFile> files;
  if (!options.json.empty()) {
    files.push_back(
        {options.json, [&](const std::filesystem::path& path) { write_text(path, json_text(to_json(report))); }});
  }
  if (options.folder.empty()) return files;
  const auto add = [&](const char* name, const auto& image, const auto& metadata, const pathtracer::Tone& tone) {
    files.push_back({options.folder / name, [=](const std::filesystem::path& path) {
                       pathtracer::write_image(path, image(), metadata(), tone);
                     }});
  };
  const auto add_rendering = [&](const char* name, const Rendering& rendering) {
    add(
        name, [&rendering] { return rendering.image; }, [&rendering] { return rendering.metadata; }, options.tone);
  };
  const auto metadata = [&report] {
    pathtracer::ImageMetadata both = report.a.metadata;
    if (report.a.trace != report.b.trace) both.erase("trace");
    both["device"] = report.a.device.name + " minus " + report.b.device.name;
    return both;
  };
  add_rendering("a.exr", report.a);
  add_rendering("a.png", report.a);
  add_rendering("b.exr", report.b);
  add_rendering("b.png", report.b);
  add("difference.exr", [&report] { return compare::signed_difference(report.a.image, report.b.image); }, metadata, {});
  add("difference.png", [&report] { return compare::heat_map(report.a.image, report.b.image); }, metadata, {});
  return files;
}

int compare_devices(const Options& options) {
  const RenderJob job = load_job(options.render);
  const pathtracer::Scene& scene = job.scene;
  const pathtracer::RenderSettings& settings = job.settings;
  // Both before the first rendering, so that a wrong name or a picture too large for one of them does not cost any.
  const rhi::DeviceHandle device_a = open_device(options.a, options.render);
  const rhi::DeviceHandle device_b = open_device(options.b, options.render);
  pathtracer::Renderer renderer_a(device_a, scene, settings, options.trace_a ? options.trace_a : options.render.trace);
  pathtracer::Renderer renderer_b(device_b, scene, settings, options.trace_b ? options.trace_b : options.render.trace);
  std::optional<pathtracer::Renderer> arbiter;
  if (!options.arbiter.empty()) arbiter.emplace(open_device(options.arbiter, options.render), scene, settings);
  DiffReport report;
  const std::vector<OutputFile> files = output_files(options, report);
  const std::optional<OutputFolder> folder =
      options.folder.empty() ? std::nullopt : std::make_optional<OutputFolder>(options.folder);
  check_output_files(files);
  report.job = summary(options.render, job);
  report.tolerance = options.tolerance;
  report.a = render(renderer_a, device_a->info(), job.samples);
  print_warnings(report.a.warnings);
  report.b = render(renderer_b, device_b->info(), job.samples);
  report.metrics = compare::measure(report.a.image, report.b.image);
  report.verdict = compare::judge(report.metrics, report.tolerance);
  if (arbiter) {
    report.arbiter = options.arbiter;
    report.examination = compare::examine(renderer_a, renderer_b, *arbiter, report.a.image, report.b.image, job.samples,
                                          scene, options.arbiter_pixels);
  }
  fmt::print("{}", table(report));
  write_or_rescue(files);
  return report.verdict.agree ? exit_code::success : exit_code::differ;
}

}  // namespace

void add_diff_command(CLI::App& app, Action& action) {
  CLI::App* const command =
      app.add_subcommand("diff", "Render a scene on two devices and compare the images pixel by pixel");
  const auto options = std::make_shared<Options>();
  add_render_options(*command, options->render);
  command->add_option("--a", options->a, "The first device, the reference")->type_name("D1")->capture_default_str();
  command->add_option("--b", options->b, "The second device")->type_name("D2")->capture_default_str();
  add_trace_form(*command, "--trace-a", options->trace_a, "As --trace, for the first device only");
  add_trace_form(*command, "--trace-b", options->trace_b, "As --trace, for the second device only");
  command
      ->add_option("--arbiter", options->arbiter,
                   "Ask this device, for the pixels that differ, which of the two chose the right triangle: cpu-exact")
      ->type_name("D3");
  add_whole_number(*command, "--arbiter-pixels", options->arbiter_pixels, 1, std::uint64_t{1} << 24,
                   "Pixels to examine at most");
  command->add_option("--json", options->json, "Write all numbers and the verdict as JSON")->type_name("FILE");
  command
      ->add_option("--out", options->folder,
                   "Write a, b and their difference as .exr and .png into this folder, made if it is missing")
      ->type_name("DIR");

  add_tone_options(*command, options->tone);
  CLI::App& tolerance = *command->add_option_group("Tolerance", "When the images agree");
  add_number(tolerance, "--min-within-1e3", options->tolerance.within_1e3, 0.0, 1.0,
             "Least fraction of pixels within 1e-3 relative");
  add_number(tolerance, "--min-bit-equal", options->tolerance.bit_equal, 0.0, 1.0,
             "Least fraction of bit-equal pixels");
  add_number(tolerance, "--max-mean-difference", options->tolerance.mean, 0.0, 1.0,
             "Largest relative difference of the images' means");
  add_whole_number(tolerance, "--max-non-finite", options->tolerance.non_finite, 0, std::uint64_t{1} << 32,
                   "Most pixels of an image with a NaN or an infinity");
  command->footer(
      "Exit code: 0 the images agree, 1 they differ, 2 error.\n"
      "Examples:\n"
      "  tandem diff scenes/cornell_box.obj --a cpu --b vulkan\n"
      "  tandem diff scenes/cornell_box.obj --a vulkan:0 --b vulkan:1 --spp 64 --json diff.json --out diff\n"
      "  tandem diff scenes/foliage.obj --a cpu --trace-a query --b cpu --trace-b pipeline --min-bit-equal 1\n"
      "  tandem diff model.obj --a cpu --b vulkan --min-bit-equal 0.9999\n"
      "  tandem diff model.obj --a cpu --b vulkan --arbiter cpu-exact");
  command->callback([&action, options] { action = [options] { return compare_devices(*options); }; });
}

}  // namespace tandem::tools
