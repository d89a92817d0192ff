// Whether correct devices are ever called wrong: every scene of a list, on two devices, under many seeds. Each picture
// is measured, classified and judged as `tandem diff --classify` does, and must be accepted.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "compare/session/comparison.hpp"
#include "devices/devices.hpp"
#include "pathtracer/load/scene_loader.hpp"

namespace {

using namespace tandem;

struct Options {
  std::filesystem::path list = std::filesystem::path(TANDEM_SOURCE_DIRECTORY) / "scenes" / "gallery.json";
  std::vector<std::string> only;  ///< files of the list; empty: all
  std::string a = "cpu", b = "vulkan", arbiter = "cpu-exact";
  std::uint32_t seeds = 50;
  std::uint32_t first_seed = 1;
  std::uint32_t size = 64;
  std::uint32_t samples = 4;
};

struct Tally {
  std::uint64_t pixels = 0, differing = 0, alarms = 0;
  compare::ClassCounts counts{};

  void add(const Tally& other) {
    pixels += other.pixels;
    differing += other.differing;
    alarms += other.alarms;
    for (std::size_t i = 0; i < counts.size(); ++i) counts[i] += other.counts[i];
  }
};

std::vector<std::filesystem::path> scenes_of(const Options& options) {
  std::ifstream file(options.list);
  const nlohmann::json list = nlohmann::json::parse(file);
  std::vector<std::filesystem::path> scenes;
  for (const nlohmann::json& scene : list.at("scenes")) {
    const auto name = scene.at("file").get<std::string>();
    if (options.only.empty() || std::ranges::count(options.only, name) != 0)
      scenes.push_back(options.list.parent_path() / name);
  }
  if (scenes.empty())
    throw std::runtime_error(fmt::format("{} lists no scene that was asked for", options.list.string()));
  return scenes;
}

void print_header() {
  fmt::print("{:<34}{:>10}{:>10}", "scene", "pixels", "differ");
  for (std::size_t i = 0; i < compare::difference_class_count; ++i)
    fmt::print("  {}", compare::name(static_cast<compare::DifferenceClass>(i)));
  fmt::print("  false alarms\n");
  std::fflush(stdout);
}

void print(const std::string& name, const Tally& tally) {
  fmt::print("{:<34}{:>10}{:>10}", name, tally.pixels, tally.differing);
  for (std::size_t i = 0; i < compare::difference_class_count; ++i) {
    const std::string heading = compare::name(static_cast<compare::DifferenceClass>(i));
    fmt::print("  {:>{}}", tally.counts[i], heading.size());
  }
  fmt::print("  {:>12}\n", tally.alarms);
  std::fflush(stdout);
}

/// The first few.
void print_mismatches(const std::filesystem::path& path, std::uint32_t seed, const compare::Classification& found) {
  std::size_t left = 3;
  for (const compare::ClassifiedPath& classified : found.paths) {
    for (const compare::Divergence& divergence : classified.divergences) {
      if (divergence.difference_class != compare::DifferenceClass::mismatch || left == 0) continue;
      --left;
      fmt::print("  {} seed {} pixel {},{} sample {}: {}\n", path.filename().string(), seed, classified.path.pixel.x,
                 classified.path.pixel.y, classified.path.sample, divergence.sentence);
    }
  }
}

/// All seeds of one scene. Alarms are printed as they come.
Tally examine(const std::filesystem::path& path, const Options& options, const compare::ComparedDevices& devices) {
  compare::Job job{.scene = pathtracer::load_scene(path), .settings = {}, .samples = options.samples, .file = path};
  job.settings = pathtracer::render_settings(job.scene.settings);
  job.settings.width = job.settings.height = options.size;
  job.settings.planned_samples = options.samples;
  compare::ComparisonOptions comparison_options;
  comparison_options.thresholds = compare::thresholds_of(path);
  comparison_options.classify = true;
  // One session: no seed uploads the scene again.
  compare::Session session = compare::prepare(devices, std::move(job), comparison_options);
  Tally tally;
  for (std::uint32_t i = 0; i < options.seeds; ++i) {
    pathtracer::RenderSettings settings = session.job.settings;
    settings.seed = options.first_seed + i;
    session.a.restart(settings);
    session.b.restart(settings);
    session.arbiter->configure(settings);
    const compare::Comparison comparison = compare::compare_devices(session);
    const compare::Classification& found = *comparison.classification;
    const compare::Verdict& verdict = comparison.verdict;
    Tally one{.pixels = comparison.metrics.pixels,
              .differing = found.differing_pixels,
              .alarms = verdict.outcome != compare::Outcome::differ ? 0u : 1u,
              .counts = found.divergence_counts};
    tally.add(one);
    if (verdict.outcome != compare::Outcome::differ) continue;
    for (const std::string& reason : verdict.reasons)
      fmt::print("  {} seed {}: {}\n", path.filename().string(), settings.seed, reason);
    print_mismatches(path, settings.seed, found);
  }
  return tally;
}

int run(const Options& options) {
  const std::vector<std::filesystem::path> scenes = scenes_of(options);
  const compare::ComparedDevices devices = compare::with_programs(
      create_device({.name = options.a}), create_device({.name = options.b}), create_device({.name = options.arbiter}));
  print_header();
  Tally all;
  for (const std::filesystem::path& scene : scenes) {
    const Tally tally = examine(scene, options, devices);
    print(scene.filename().string(), tally);
    all.add(tally);
  }
  print(fmt::format("{} scenes x {} seeds", scenes.size(), options.seeds), all);
  return all.alarms == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Looks for false alarms: scenes on two devices, under many seeds.");
  Options options;
  app.add_option("--list", options.list, "The list of scenes");
  app.add_option("--only", options.only, "Files of the list");
  app.add_option("--a", options.a, "The first device");
  app.add_option("--b", options.b, "The second device");
  app.add_option("--arbiter", options.arbiter, "The device that decides");
  app.add_option("--seeds", options.seeds, "How many seeds")->check(CLI::PositiveNumber);
  app.add_option("--first-seed", options.first_seed, "The first of them");
  app.add_option("--size", options.size, "Side of the pictures in pixels")->check(CLI::PositiveNumber);
  app.add_option("--spp", options.samples, "Samples per pixel")->check(CLI::PositiveNumber);
  CLI11_PARSE(app, argc, argv);
  try {
    return run(options);
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 2;
  }
}
