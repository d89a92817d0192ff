#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "compare/session/comparison.hpp"
#include "compare/session/explanation.hpp"
#include "tools/view/live_rendering.hpp"
#include "tools/view/window/state.hpp"

namespace tandem::view {

/// What the viewer leaves to the command line program around it.
struct Host {
  std::function<compare::Job(const std::filesystem::path& scene)> load;  ///< throws Error
  LiveRendering::OpenDevice open;                                        ///< from any thread
  std::function<std::string(const compare::Explanation&)> explanation_text;
  /// Writes a report of the comparison into a folder. Throws Error.
  std::function<void(compare::Session& session, const std::filesystem::path& folder)> write_report;
  std::function<void(const std::filesystem::path& file, const std::string& text)> write_text;  ///< throws Error
};

struct ViewerOptions {
  DeviceChoice a, b;  ///< b without a name: one device
  std::string arbiter;
  std::filesystem::path output;  ///< what saved files are called, without an extension
  pathtracer::AccumulationSettings accumulation;
  Display display;
  std::vector<std::string> devices;
  std::vector<std::filesystem::path> scenes;
};

/// Shows the window until it is closed. Throws Error when there is no display.
void run_viewer(const Host& host, const ViewerOptions& options, compare::Job job);

}  // namespace tandem::view
