// What takes time, in the background: paths, classes, reports, other scenes; and what is saved.

#include "tools/view/window/viewer_loop.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "base/error.hpp"
#include "compare/cause/class_map.hpp"
#include "pathtracer/image/image_io.hpp"
#include "tools/view/scene_file.hpp"

namespace tandem::view {

compare::Job ViewerLoop::job_as_shown() const {
  compare::Job job = job_;
  job.scene.lights = state_.view.lights;
  job.settings = state_.view.settings;
  job.samples = std::max(shown_samples(), 1u);
  return job;
}

compare::ComparisonOptions ViewerLoop::comparison_options() const {
  compare::ComparisonOptions wanted;
  wanted.trace_a = state_.a.trace;
  wanted.trace_b = state_.b.trace;
  wanted.classify = true;
  return wanted;
}

std::uint32_t ViewerLoop::shown_samples() const { return a_ ? a_->samples : 0; }

void ViewerLoop::start_task(const std::string& message, std::function<TaskResult()> task) {
  if (task_.valid()) {
    state_.message = "one thing at a time: " + state_.message;
    return;
  }
  state_.message = message;
  task_ = std::async(std::launch::async, [task = std::move(task)] {
    TaskResult result;
    try {
      result = task();
    } catch (const std::exception& error) {
      result.message = error.what();
    }
    Window::wake();
    return result;
  });
}

void ViewerLoop::finish_task() {
  const auto is_ready = [](const auto& future) {
    return future.valid() && future.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
  };
  std::erase_if(retired_, [](const std::unique_ptr<LiveRendering>& retired) { return retired->has_ended(); });
  if (is_ready(task_)) {
    TaskResult result = task_.get();
    state_.message = result.message;
    if (!result.path_text.empty()) state_.path_text = result.path_text;
    if (result.classes) classes_ = result.classes;
    state_.wants.display = true;
  }
  if (is_ready(loading_)) {
    try {
      open(loading_.get());
      state_.message.clear();
    } catch (const std::exception& error) {
      state_.message = error.what();
    }
  }
}

void ViewerLoop::explain_pixel(glm::uvec2 pixel) {
  const std::string a = state_.a.name, b = state_.two_devices() ? state_.b.name : options_.arbiter;
  compare::ExplanationOptions wanted;
  wanted.pixel = pixel;
  wanted.trace_a = state_.a.trace;
  if (state_.two_devices()) wanted.trace_b = state_.b.trace;
  start_task(fmt::format("tracing the paths of pixel {},{}", pixel.x, pixel.y),
             [host = host_, job = job_as_shown(), wanted, a, b, arbiter = options_.arbiter] {
               const compare::Explanation explanation = compare::explain(
                   {.a = host->open(a), .b = host->open(b), .arbiter = host->open(arbiter)}, job, wanted);
               return TaskResult{.message = fmt::format("pixel {},{}: {}", wanted.pixel.x, wanted.pixel.y,
                                                        explanation.first ? "the paths differ" : "the same paths"),
                                 .path_text = host->explanation_text(explanation)};
             });
}

void ViewerLoop::classify() {
  if (!state_.two_devices()) return;
  const compare::ComparisonOptions wanted = comparison_options();
  start_task("classing the differences", [host = host_, job = job_as_shown(), wanted, a = state_.a.name,
                                          b = state_.b.name, arbiter = options_.arbiter] {
    const compare::Comparison comparison =
        compare::compare_devices({.a = host->open(a), .b = host->open(b), .arbiter = host->open(arbiter)}, job, wanted);
    return TaskResult{.message = "differences classed",
                      .classes = std::make_shared<const pathtracer::Image>(
                          compare::class_map(*comparison.classification, comparison.a.image, comparison.b.image))};
  });
}

void ViewerLoop::write_report() {
  if (!state_.two_devices()) return;
  const std::filesystem::path folder = options_.output.string() + "-report";
  const compare::ComparisonOptions wanted = comparison_options();
  start_task("writing the report", [host = host_, job = job_as_shown(), wanted, folder, a = state_.a.name,
                                    b = state_.b.name, arbiter = options_.arbiter] {
    compare::Session session =
        compare::prepare({.a = host->open(a), .b = host->open(b), .arbiter = host->open(arbiter)}, job, wanted);
    host->write_report(session, folder);
    return TaskResult{.message = fmt::format("written: {}", (folder / "index.html").string())};
  });
}

void ViewerLoop::save() {
  if (!a_ || a_->is_preview) {
    state_.message = "nothing to save yet: the picture has no sample";
    return;
  }
  try {
    const std::string stem = options_.output.string();
    const std::filesystem::path folder =
        options_.output.has_parent_path() ? options_.output.parent_path() : std::filesystem::path(".");
    const nlohmann::ordered_json description = scene_description(
        {.scene_file = job_.file, .scene = job_.scene, .view = state_.view, .samples = a_->samples}, folder);
    const auto write = [&](const std::string& name, const Frame& frame) {
      pathtracer::write_image(name + ".exr", frame.image, frame.metadata);
      pathtracer::write_image(name + ".png", frame.image, frame.metadata, state_.display.tone);
    };
    write(stem, *a_);
    if (b_ && !b_->is_preview) write(stem + "-b", *b_);
    // Last, so that who waits for it finds all.
    host_->write_text(stem + ".json", description.dump(2) + "\n");
    state_.message = fmt::format("saved: {0}.exr, {0}.png, {0}.json", stem);
  } catch (const std::exception& error) {
    state_.message = error.what();
  }
}

}  // namespace tandem::view
