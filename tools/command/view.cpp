#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "base/error.hpp"
#include "devices/devices.hpp"
#include "tools/command.hpp"
#include "tools/options/device_options.hpp"
#include "tools/options/job.hpp"
#include "tools/options/option_values.hpp"
#include "tools/options/render_options.hpp"
#include "tools/output/output_file.hpp"
#include "tools/report/comparison_report.hpp"
#include "tools/report/device_json.hpp"
#include "tools/report/explanation_report.hpp"
#include "tools/report/report_page.hpp"
#if TANDEM_HAS_VIEWER
#include <dlfcn.h>

#include "tools/view/window/viewer_module.hpp"
#endif

namespace tandem::tools {
namespace {

struct Options {
  RenderOptions render;
  std::string a = "cpu";
  std::string b;
  std::string arbiter = "cpu-exact";
  std::filesystem::path output = "view";
  std::uint32_t samples_per_frame = 1;
  pathtracer::Tone tone;
};

#if TANDEM_HAS_VIEWER

/// The window's library, found by the run path of the program. Throws Error.
const view::ViewerModule& viewer() {
  const auto fail = [](const std::string& why) {
    return Error(fmt::format("the library for windows cannot be loaded: {}", why));
  };
  void* const library = ::dlopen(TANDEM_VIEWER_FILE, RTLD_LAZY | RTLD_LOCAL);
  if (library == nullptr) throw fail(::dlerror());
  const auto entry = reinterpret_cast<view::ViewerEntry>(::dlsym(library, view::viewer_entry));
  if (entry == nullptr) throw fail(fmt::format("'{}' exports no {}", TANDEM_VIEWER_FILE, view::viewer_entry));
  const view::ViewerModule& module = *entry();
  if (module.version != std::string_view(TANDEM_VERSION))
    throw fail(
        fmt::format("'{}' is of Tandem {}, this program of {}", TANDEM_VIEWER_FILE, module.version, TANDEM_VERSION));
  return module;
}

/// Scene files in the folder of the one that is shown.
std::vector<std::filesystem::path> scenes_beside(const std::filesystem::path& scene) {
  std::vector<std::filesystem::path> files;
  const std::filesystem::path folder = scene.has_parent_path() ? scene.parent_path() : std::filesystem::path(".");
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
    const std::string extension = entry.path().extension().string();
    const std::string name = entry.path().filename().string();
    // Other JSON files lie beside scenes: their thresholds, suites.
    if (extension == ".obj" || extension == ".gltf" || extension == ".glb" ||
        (extension == ".json" && name.find(".thresholds.") == std::string::npos))
      files.push_back(scene.has_parent_path() ? entry.path() : entry.path().filename());
  }
  std::ranges::sort(files);
  return files;
}

int view(const Options& options) {
  check_output_path(options.output.string() + ".json");
  const view::ViewerModule& module = viewer();
  view::ViewerOptions wanted;
  wanted.a = {options.a, options.render.trace};
  wanted.b = {options.b, options.render.trace};
  wanted.arbiter = options.arbiter;
  wanted.output = options.output;
  wanted.accumulation.samples_per_frame = options.samples_per_frame;
  wanted.accumulation.maximum_samples = options.render.settings.samples.value_or(wanted.accumulation.maximum_samples);
  wanted.display.tone = options.tone;
  for (const rhi::DeviceInfo& device : enumerate_devices()) wanted.devices.push_back(device.name);
  wanted.scenes = scenes_beside(options.render.scene);
  const view::Host host{
      .load =
          [&options](const std::filesystem::path& file) {
            RenderOptions render = options.render;
            if (file != render.scene) {
              // Where the camera of the first scene was says nothing of another one.
              render.camera_position.reset();
              render.camera_target.reset();
            }
            render.scene = file;
            return load_job(render);
          },
      .open = [&options](const std::string& name) { return open_device(name, options.render); },
      .explanation_text = [](const compare::Explanation& explanation) { return table(explanation); },
      .write_report =
          [](compare::Session& session, const std::filesystem::path& folder) {
            const OutputFolder made(folder);
            session.options = with_metrics_for_page(session.options);
            const compare::Comparison comparison = compare_devices(session);
            write_text(folder / "index.html", report_page(session, comparison, json_text(to_json(comparison))));
          },
      .write_text = [](const std::filesystem::path& file, const std::string& text) { write_text(file, text); }};
  module.run_viewer(host, wanted, host.load(options.render.scene));
  return exit_code::success;
}

#else

int view(const Options&) {
  throw Error(
      "this program was built without 'tandem view': install libglfw3-dev, libimgui-dev and libgl-dev, then "
      "build it again");
}

#endif

}  // namespace

void add_view_command(CLI::App& app, Action& action) {
  CLI::App* const command =
      app.add_subcommand("view", "Show a scene in a window, on one device or on two with their difference");
  const auto options = std::make_shared<Options>();
  add_render_options(*command, options->render);
  command->add_option("--a,--device", options->a, "The device")->type_name("D")->capture_default_str();
  command->add_option("--b", options->b, "A second device, which is compared with the first")->type_name("D");
  command->add_option("--arbiter", options->arbiter, "Device that decides which of two ray hits is right")
      ->type_name("D3")
      ->capture_default_str();
  command
      ->add_option("-o,--output", options->output,
                   "What is saved: NAME.exr, NAME.png and NAME.json, those of b as NAME-b, the report as NAME-report/")
      ->type_name("NAME")
      ->capture_default_str();
  command->add_option("--spp-per-frame", options->samples_per_frame, "Samples per pixel of one frame")
      ->type_name("N")
      ->check(CLI::Range(1u, 1024u))
      ->capture_default_str();
  add_tone_options(*command, options->tone);
  command->footer(
      "--spp is the number of samples after which a picture is finished [4096].\n"
      "Left button: orbit. Wheel, right button: dolly. Ctrl+left, middle button: pan. Alt+left: look around. WASD, "
      "EQ:\n"
      "walk. Click: explain the pixel. 1 to 7: a, b, split, side by side, flicker, difference, classes. [ ]: move the\n"
      "line. - +: exposure. T: tone map. Space: accumulation. R: anew. Home: first camera. N, Delete, J, K: lights.\n"
      "F2, F3: next device. Ctrl+S: save. Ctrl+R: report. F10: hide the panel, which lists all keys. Ctrl+Q: close.\n"
      "Exit code: 0 the window was closed, 2 error, such as no display.\n"
      "Examples:\n"
      "  tandem view scenes/cornell_box.obj\n"
      "  tandem view scenes/cornell_box.obj --a cpu --b vulkan");
  command->callback([&action, options] { action = [options] { return view(*options); }; });
}

}  // namespace tandem::tools
