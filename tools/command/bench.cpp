#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "base/text_file.hpp"
#include "tools/bench/measurement.hpp"
#include "tools/bench/page.hpp"
#include "tools/bench/slower.hpp"
#include "tools/command.hpp"
#include "tools/kernels/kernel.hpp"
#include "tools/kernels/kernel_run.hpp"
#include "tools/options/device_options.hpp"
#include "tools/options/job.hpp"
#include "tools/options/option_values.hpp"
#include "tools/output/messages.hpp"
#include "tools/output/output_file.hpp"
#include "tools/output/print.hpp"
#include "tools/output/progress_bar.hpp"
#include "tools/output/run_record.hpp"
#include "tools/report/bench_report.hpp"
#include "tools/report/device_json.hpp"
#include "tools/report/kernel_report.hpp"

namespace tandem::tools {
namespace {

struct Options {
  RenderOptions render;
  std::vector<std::filesystem::path> scenes;
  std::vector<std::string> words;  ///< the options of rendering that are given
  std::vector<std::string> variations;
  std::vector<std::string> devices;
  std::uint32_t rounds = 5;
  bool first_picture = false;
  bool quick = false;
  std::filesystem::path json, csv, page, baseline;  ///< empty: none
  std::optional<std::string> kernels;               ///< in place of a scene: a list of names; "": all
};

/// A first picture that takes longer is none that a person waits for.
constexpr std::chrono::minutes patience{30};
/// With --quick: of each device.
constexpr std::chrono::seconds quick_patience{15};

void write_files(const std::vector<OutputFile>& files) {
  write_or_rescue(files);
  print_written(files);
}

OutputFile text_file(const std::filesystem::path& path, const std::function<std::string()>& text) {
  return {path, [text](const std::filesystem::path& temporary) { write_text(temporary, text()); }};
}

/// The stored run. Throws Error.
nlohmann::ordered_json read_baseline(const std::filesystem::path& path) {
  try {
    return nlohmann::ordered_json::parse(read_text(path));
  } catch (const nlohmann::json::exception&) {
    throw Error(fmt::format("{}: it is no JSON", path.string()));
  }
}

/// Says what has changed since the stored run.
int compare_with_baseline(const Options& options, const nlohmann::ordered_json& stored,
                          const nlohmann::ordered_json& now) {
  SpeedChanges changes;
  try {
    changes = speed_changes(stored, now);
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", options.baseline.string(), error.what()));
  }
  print("\nBeside {}: {} slower, {} faster, {} unchanged, {} new, {} gone\n", options.baseline.string(),
        changes.slower.size(), changes.faster.size(), changes.unchanged, changes.unmatched.size(), changes.gone.size());
  for (const std::string& sentence : changes.slower) print("  slower  {}\n", sentence);
  for (const std::string& sentence : changes.faster) print("  faster  {}\n", sentence);
  for (const std::string& name : changes.unmatched) print("  new     {}\n", name);
  for (const std::string& name : changes.gone) print("  gone    {}\n", name);
  return changes.slower.empty() ? exit_code::success : exit_code::failed;
}

RenderOptions quick_options(RenderOptions options) {
  if (!options.size) options.size = glm::uvec2(128, 128);
  if (!options.settings.samples) options.settings.samples = 4;
  return options;
}

int measure_speed(const Options& options) {
  BenchReport report;
  nlohmann::ordered_json json;
  const std::string command = command_line();
  std::vector<OutputFile> files;
  const auto numbers = [&json] { return json_text(json); };
  if (!options.json.empty()) files.push_back(text_file(options.json, numbers));
  if (!options.csv.empty()) files.push_back(text_file(options.csv, [&report] { return csv(report); }));
  if (!options.page.empty())
    files.push_back(text_file(options.page, [&] { return bench_page(report, command, numbers()); }));
  check_output_files(files);
  std::optional<nlohmann::ordered_json> stored;
  if (!options.baseline.empty()) stored = read_baseline(options.baseline);

  std::vector<Variation> variations;
  for (const std::string& text : options.variations) variations.push_back(parse_variation(text));
  MeasureOptions measuring{.devices = options.devices, .rounds = options.rounds};
  if (options.first_picture) measuring.first_picture_limit = patience;
  if (options.quick) measuring.first_picture_limit = quick_patience;
  const RenderOptions base = options.quick ? quick_options(options.render) : options.render;
  report = measure(configurations(base, options.words, options.scenes, variations), measuring);
  json = to_json(report);
  print("{}", table(report));
  if (!files.empty()) write_files(files);
  return stored ? compare_with_baseline(options, *stored, json) : exit_code::success;
}

int measure_kernels(const Options& options) {
  KernelReport report{.threads = options.render.threads, .devices = {}, .kernels = {}};
  std::vector<OutputFile> files;
  if (!options.json.empty()) files.push_back(text_file(options.json, [&report] { return json_text(to_json(report)); }));
  check_output_files(files);
  const std::vector<kernels::Kernel> chosen = kernels::named_kernels(*options.kernels);
  std::vector<rhi::DeviceHandle> devices;
  for (const std::string& name : options.devices) {
    devices.push_back(open_device(name, options.render));
    report.devices.push_back(devices.back()->info());
  }
  const Progress preparation = progress_bar("preparing kernels");
  std::vector<kernels::Problem> problems;
  for (const kernels::Kernel& kernel : chosen) problems.push_back(kernel.problem(kernels::Size::usual));
  std::vector<std::vector<kernels::KernelRun>> runs(chosen.size());  // of each kernel, on each device
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    report.kernels.push_back({.name = chosen[i].name, .description = chosen[i].description, .series = {}});
    for (const rhi::DeviceHandle& device : devices) {
      if (!preparation(static_cast<double>(i) / static_cast<double>(chosen.size()))) throw Cancelled();
      runs[i].emplace_back(device, chosen[i], problems[i]);
      report.kernels[i].series.push_back({.compile_milliseconds = runs[i].back().compile_milliseconds()});
    }
  }
  // As for a scene: round 0 warms up, and the devices take turns with each kernel.
  const Progress progress = progress_bar("kernels");
  for (std::uint32_t round = 0; round <= options.rounds; ++round) {
    for (std::size_t i = 0; i < chosen.size(); ++i) {
      if (!progress(static_cast<double>(round) / (options.rounds + 1.0))) throw Cancelled();
      for (std::size_t index = 0; index < devices.size(); ++index) {
        try {
          const double milliseconds = runs[i][index].run();
          if (round > 0) report.kernels[i].series[index].milliseconds.push_back(milliseconds);
        } catch (const kernels::WrongAnswer& wrong) {
          print_error_line(wrong.what());
          return exit_code::failed;
        }
      }
    }
  }
  print("{}", table(report));
  if (!files.empty()) write_files(files);
  return exit_code::success;
}

/// The options of rendering that the command line has, as words.
void collect_words(const CLI::App& command, const std::set<std::string>& others, std::vector<std::string>& words) {
  for (const CLI::Option* option : command.get_options()) {
    const std::string name = option->get_name();
    if (option->count() == 0 || others.contains(name)) continue;
    words.push_back(name);
    if (option->get_items_expected_max() > 0)
      words.insert(words.end(), option->results().begin(), option->results().end());
  }
  for (const CLI::App* group : command.get_subcommands([](const CLI::App*) { return true; }))
    collect_words(*group, others, words);
}

/// The options that are not about rendering.
const std::set<std::string> own_options = {"SCENE",  "--kernels",       "--device",   "--repeat",
                                           "--vary", "--first-picture", "--quick",    "--json",
                                           "--csv",  "--html",          "--baseline", "--help"};

/// Throws for options that say how to render a scene, which kernels have none of.
void refuse_scene_options(const CLI::App& command) {
  static constexpr const char* taken[] = {"--kernels", "--device", "--repeat", "--json", "--threads", "--validation"};
  for (const CLI::Option* option : command.get_options()) {
    if (option->count() == 0) continue;
    const std::string name = option->get_name();
    if (std::ranges::find(taken, name) == std::end(taken))
      throw CLI::ValidationError("--kernels", name + " is about a scene, and no scene is rendered");
  }
  for (const CLI::App* group : command.get_subcommands([](const CLI::App*) { return true; }))
    refuse_scene_options(*group);
}

}  // namespace

void add_bench_command(CLI::App& app, Action& action) {
  CLI::App* const command = app.add_subcommand(
      "bench", "Measure how fast devices render a scene or run compute kernels, in alternating runs");
  const auto options = std::make_shared<Options>();
  add_render_options(*command, options->render);
  command->remove_option(command->get_option("SCENE"));
  command
      ->add_option("SCENE", options->scenes, "Wavefront OBJ, glTF (.gltf, .glb) or scene description (.json); several")
      ->type_name("FILE...");
  std::string names;
  for (const kernels::Kernel& kernel : kernels::kernels())
    names += fmt::format("{}{}", names.empty() ? "" : ", ", kernel.name);
  command
      ->add_option_function<std::vector<std::string>>(
          "--kernels",
          [options](const std::vector<std::string>& given) { options->kernels = given.empty() ? "" : given.front(); },
          "Measure compute kernels in place of a scene, and check their answers: all, or those of the list, of " +
              names)
      ->expected(0, 1)
      ->allow_extra_args(false)
      ->type_name("NAME,NAME,...");
  add_devices(*command, options->devices, "Devices to measure; the first is the reference of the ratios")->required();
  add_whole_number(*command, "--repeat", options->rounds, 1, 10'000, "Measured rounds, after one warm-up round");
  command
      ->add_option(
          "--vary", options->variations,
          "Measure all values of an option of rendering: spp=1,4,16, size=128x128,512x512, trace=query,pipeline, "
          "threads=1,2; repeat it for all combinations")
      ->type_name("NAME=VALUE,...")
      ->allow_extra_args(false);
  command->add_flag("--first-picture", options->first_picture,
                    "Time a program of its own from its start to the first picture, once for each device and setting");
  command->add_flag(
      "--quick", options->quick,
      "End within a minute: 128x128 pixels and 4 samples unless given, and no device whose driver compiles "
      "shaders for long");
  command->add_option("--json", options->json, "Write all measurements, round by round, as JSON")->type_name("FILE");
  command->add_option("--csv", options->csv, "Write a line for each round")->type_name("FILE");
  command->add_option("--html", options->page, "Write a page with plots and tables, which opens from disk")
      ->type_name("FILE");
  command
      ->add_option(
          "--baseline", options->baseline,
          "Compare with what --json has written on this machine, and exit with 1 where something became slower")
      ->type_name("FILE");
  command->footer(
      "Times are milliseconds on the device (by its timestamps where it has them), without loading and building.\n"
      "Intervals hold the median of the distribution with the probability beside them.\n"
      "Exit code: 0 measured, 1 slower than the baseline or a kernel answered wrongly, 2 error.\n"
      "Examples:\n"
      "  tandem bench scenes/cornell_box.obj --device vulkan,cpu --repeat 9 --json bench.json\n"
      "  tandem bench scenes/cornell_box.obj --device cpu --vary spp=1,4,16 --vary threads=1,2 --html bench.html\n"
      "  tandem bench --quick scenes/cornell_box.obj --device cpu --device vulkan\n"
      "  tandem bench --kernels --device vulkan,cpu,cpu-scalar\n"
      "  tandem bench --kernels fft,n-body --device vulkan,cpu");
  command->callback([&action, options, command] {
    if (!options->kernels) {
      if (options->scenes.empty()) throw CLI::RequiredError("SCENE");
      collect_words(*command, own_options, options->words);
      if (options->quick) {
        if (command->get_option("--spp")->count() == 0) options->words.insert(options->words.end(), {"--spp", "4"});
        if (command->get_option("--size")->count() == 0)
          options->words.insert(options->words.end(), {"--size", "128x128"});
      }
      action = [options] { return measure_speed(*options); };
      return;
    }
    refuse_scene_options(*command);
    action = [options] { return measure_kernels(*options); };
  });
}

}  // namespace tandem::tools
