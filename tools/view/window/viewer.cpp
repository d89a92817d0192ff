#include "tools/view/window/viewer.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <future>
#include <utility>

#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include "base/error.hpp"
#include "compare/cause/class_map.hpp"
#include "pathtracer/image/image_io.hpp"
#include "tools/view/camera_controls.hpp"
#include "tools/view/scene_file.hpp"
#include "tools/view/window/window.hpp"

namespace tandem::view {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int panel_width = 330;
constexpr double settle_seconds = 0.15;  ///< without a change, after which a camera counts as at rest
constexpr double flicker_seconds = 0.4;

double seconds(Clock::time_point from, Clock::time_point to) {
  return std::chrono::duration<double>(to - from).count();
}

/// Where the picture is in the window.
struct Placement {
  glm::ivec2 offset{0}, size{1};
  double scale = 1;
};

/// As large as fits, pixel by pixel where it is not to be smaller.
Placement place(glm::ivec2 room, glm::ivec2 picture) {
  Placement placement;
  placement.scale = std::min(double(room.x) / picture.x, double(room.y) / picture.y);
  if (placement.scale >= 1) placement.scale = std::floor(placement.scale);
  placement.size = glm::max(glm::ivec2(glm::dvec2(picture) * placement.scale), glm::ivec2(1));
  placement.offset = (room - placement.size) / 2;
  return placement;
}

/// What a task in the background ends with: it is to be shown in a window of its own, or as a message.
struct TaskResult {
  std::string message;
  std::string path_text = {};
  std::shared_ptr<const pathtracer::Image> classes = {};
};

class Viewer {
 public:
  Viewer(const Host& host, const ViewerOptions& options, compare::Job job);
  void run();

 private:
  void open(compare::Job job);
  void start_rendering();
  compare::Job job_as_shown() const;
  compare::ComparisonOptions comparison_options() const;
  void press(int button, bool pressed, int modifiers, glm::dvec2 position);
  void move(glm::dvec2 position);
  void change_camera(const pathtracer::Camera& camera);
  void walk_by_keys(double elapsed);
  void answer_wants();
  void take_frames();
  void compose_picture();
  void start_task(const std::string& message, std::function<TaskResult()> task);
  void finish_task();
  void explain_pixel(glm::uvec2 pixel);
  void classify();
  void write_report();
  void save();
  Placement placement() const;
  std::string title() const;
  std::uint32_t shown_samples() const;

  const Host* host_;
  ViewerOptions options_;
  State state_;
  compare::Job job_;  ///< as loaded
  Window window_;
  std::unique_ptr<LiveRendering> rendering_;
  std::vector<std::unique_ptr<LiveRendering>> retired_;  ///< that end when their drivers let them
  std::vector<DeviceState> devices_;
  FrameHandle a_, b_;  ///< shown: of two devices a pair, as soon as there is one
  std::shared_ptr<const pathtracer::Image> classes_;
  bool picture_changed_ = true;
  glm::ivec2 picture_size_{1};
  std::future<TaskResult> task_;
  std::future<compare::Job> loading_;
  bool moving_ = false;
  Clock::time_point last_change_ = Clock::now(), last_flicker_ = Clock::now();

  int button_ = -1;  ///< that is down in the picture
  int modifiers_ = 0;
  glm::dvec2 pressed_at_{0}, last_position_{0};
  bool dragged_ = false, drags_line_ = false;
};

State first_state(const ViewerOptions& options) {
  State state;
  state.a = options.a;
  state.b = options.b;
  state.devices = options.devices;
  state.scenes = options.scenes;
  state.display = options.display;
  state.view.accumulation = options.accumulation;
  if (!state.two_devices()) state.display.mode = DisplayMode::a;
  return state;
}

Viewer::Viewer(const Host& host, const ViewerOptions& options, compare::Job job)
    : host_(&host),
      options_(options),
      state_(first_state(options)),
      window_(
          {static_cast<int>(std::clamp(job.settings.width, 160u, 2048u)) + panel_width,
           static_cast<int>(std::clamp(job.settings.height, 480u, 1400u))},
          "Tandem",
          {.key = [this](int key, int modifiers) { press_key(state_, key, modifiers); },
           .button = [this](int button, bool pressed, int modifiers,
                            glm::dvec2 position) { press(button, pressed, modifiers, position); },
           .move = [this](glm::dvec2 position) { move(position); },
           .wheel = [this](double steps) { change_camera(dolly(*state_.view.settings.camera, std::pow(0.9, steps))); },
           .drop = [this](const std::filesystem::path& file) { state_.wants.scene = file; }}) {
  open(std::move(job));
}

void Viewer::open(compare::Job job) {
  job_ = std::move(job);
  state_.scene_file = job_.file;
  state_.scene = std::make_shared<const pathtracer::Scene>(job_.scene);
  View& view = state_.view;
  view.settings = job_.settings;
  view.settings.planned_samples = view.accumulation.maximum_samples;
  if (!view.settings.camera)
    view.settings.camera = job_.scene.camera
                               ? *job_.scene.camera
                               : pathtracer::automatic_camera(job_.scene, static_cast<float>(view.settings.width) /
                                                                              static_cast<float>(view.settings.height));
  state_.first_camera = *view.settings.camera;
  view.lights = job_.scene.lights;
  state_.light = 0;
  start_rendering();
}

void Viewer::start_rendering() {
  if (rendering_) {
    rendering_->stop();
    retired_.push_back(std::move(rendering_));
  }
  a_ = b_ = nullptr;
  classes_ = nullptr;
  state_.differing.reset();
  std::vector<DeviceChoice> choices = {state_.a};
  if (state_.two_devices()) choices.push_back(state_.b);
  auto scene = std::make_shared<pathtracer::Scene>(*state_.scene);
  scene->lights = state_.view.lights;
  rendering_ = std::make_unique<LiveRendering>(std::move(scene), choices, state_.view, host_->open, &Window::wake);
  moving_ = false;
}

compare::Job Viewer::job_as_shown() const {
  compare::Job job = job_;
  job.scene.lights = state_.view.lights;
  job.settings = state_.view.settings;
  job.samples = std::max(shown_samples(), 1u);
  return job;
}

compare::ComparisonOptions Viewer::comparison_options() const {
  compare::ComparisonOptions wanted;
  wanted.trace_a = state_.a.trace;
  wanted.trace_b = state_.b.trace;
  wanted.classify = true;
  return wanted;
}

std::uint32_t Viewer::shown_samples() const { return a_ ? a_->samples : 0; }

Placement Viewer::placement() const {
  const glm::ivec2 size = window_.size();
  return place(glm::max(glm::ivec2(size.x - (state_.panel ? panel_width : 0), size.y), glm::ivec2(1)), picture_size_);
}

void Viewer::press(int button, bool pressed, int modifiers, glm::dvec2 position) {
  const Placement where = placement();
  if (pressed) {
    const double line = where.offset.x + double{state_.display.split} * where.size.x;
    drags_line_ = button == GLFW_MOUSE_BUTTON_LEFT && state_.two_devices() &&
                  state_.display.mode == DisplayMode::split && std::abs(position.x - line) <= 5;
    button_ = button;
    modifiers_ = modifiers;
    pressed_at_ = last_position_ = position;
    dragged_ = false;
    return;
  }
  const bool clicked = button == button_ && button == GLFW_MOUSE_BUTTON_LEFT && !dragged_ && !drags_line_;
  if (button == button_) button_ = -1;
  if (!clicked) return;
  const glm::dvec2 pixel = (position - glm::dvec2(where.offset)) / where.scale;
  const pathtracer::RenderSettings& settings = state_.view.settings;
  if (pixel.x < 0 || pixel.y < 0 || pixel.x >= picture_size_.x || pixel.y >= settings.height) return;
  // Side by side the same pixel is there twice.
  state_.wants.explain =
      glm::uvec2(static_cast<std::uint32_t>(pixel.x) % settings.width, static_cast<std::uint32_t>(pixel.y));
}

void Viewer::move(glm::dvec2 position) {
  if (button_ < 0) return;
  const Placement where = placement();
  constexpr double click_radius = 3;
  if (glm::distance(position, pressed_at_) > click_radius) dragged_ = true;
  if (drags_line_) {
    state_.display.split = static_cast<float>(std::clamp((position.x - where.offset.x) / where.size.x, 0.0, 1.0));
    state_.wants.display = true;
    return;
  }
  if (!dragged_) return;
  const glm::dvec2 step = (position - last_position_) / double(where.size.y);
  last_position_ = position;
  const pathtracer::Camera& camera = *state_.view.settings.camera;
  constexpr double half_turn = 3.14159265358979;  // over the height of the picture
  const bool left = button_ == GLFW_MOUSE_BUTTON_LEFT;
  if (button_ == GLFW_MOUSE_BUTTON_MIDDLE || (left && (modifiers_ & GLFW_MOD_CONTROL) != 0))
    change_camera(pan(camera, step));
  else if (left && (modifiers_ & GLFW_MOD_ALT) != 0)
    change_camera(look(camera, glm::dvec2(step.x, -step.y) * (half_turn / 2)));
  else if (left)
    change_camera(orbit(camera, glm::dvec2(-step.x, step.y) * half_turn));
  else
    change_camera(dolly(camera, std::exp(2 * step.y)));
}

void Viewer::change_camera(const pathtracer::Camera& camera) {
  if (camera == *state_.view.settings.camera) return;
  state_.view.settings.camera = camera;
  state_.wants.view = state_.wants.moving = true;
}

void Viewer::walk_by_keys(double elapsed) {
  if (window_.is_pressed(GLFW_KEY_LEFT_CONTROL) || window_.is_pressed(GLFW_KEY_RIGHT_CONTROL)) return;
  const auto axis = [&](int forth, int back) {
    return double(window_.is_pressed(forth)) - double(window_.is_pressed(back));
  };
  const glm::dvec3 way(axis(GLFW_KEY_D, GLFW_KEY_A), axis(GLFW_KEY_E, GLFW_KEY_Q), axis(GLFW_KEY_W, GLFW_KEY_S));
  if (way == glm::dvec3(0)) return;
  const pathtracer::Camera& camera = *state_.view.settings.camera;
  const double speed = 0.5 * glm::distance(camera.position, camera.target);  // a second
  change_camera(walk(camera, way * (speed * std::min(elapsed, 0.1))));
}

void Viewer::start_task(const std::string& message, std::function<TaskResult()> task) {
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

void Viewer::finish_task() {
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

void Viewer::explain_pixel(glm::uvec2 pixel) {
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

void Viewer::classify() {
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

void Viewer::write_report() {
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

void Viewer::save() {
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

void Viewer::answer_wants() {
  auto wants = std::exchange(state_.wants, {});
  const Clock::time_point now = Clock::now();
  if (wants.scene && !loading_.valid()) {
    state_.message = "loading " + wants.scene->filename().string();
    loading_ = std::async(std::launch::async, [host = host_, file = *wants.scene] {
      compare::Job job = host->load(file);
      Window::wake();
      return job;
    });
  }
  if (wants.devices) {
    if (!state_.two_devices()) state_.display.mode = DisplayMode::a;
    if (state_.two_devices() && state_.display.mode == DisplayMode::a) state_.display.mode = DisplayMode::split;
    start_rendering();
  } else if (wants.view) {
    moving_ = wants.moving;
    last_change_ = now;
    classes_ = nullptr;
    rendering_->show(state_.view, moving_);
  } else if (moving_ && seconds(last_change_, now) > settle_seconds) {
    moving_ = false;
    rendering_->show(state_.view, false);
  }
  if (wants.display) picture_changed_ = true;
  if (wants.explain) explain_pixel(*wants.explain);
  if (wants.classes) classify();
  if (wants.report) write_report();
  if (wants.save) save();
  if (wants.close) window_.close();
}

/// Shows what is new; of two devices only pictures of the same samples, once there are any of the view.
void Viewer::take_frames() {
  devices_ = rendering_->states();
  FrameHandle a = devices_[0].frame, b = devices_.size() > 1 ? devices_[1].frame : nullptr;
  const auto is_pair = [](const FrameHandle& first, const FrameHandle& second) {
    return first && second && first->revision == second->revision && first->frame == second->frame &&
           first->is_preview == second->is_preview;
  };
  const bool waits = b && !is_pair(a, b) && a && a->revision == b->revision && is_pair(a_, b_) &&
                     a_->revision == a->revision && !b->is_preview;
  if (waits) return;
  if (a == a_ && b == b_) return;
  if (a && a != a_) {
    state_.frame_times.push_back(static_cast<float>(a->milliseconds));
    constexpr std::size_t remembered = 120;
    if (state_.frame_times.size() > remembered) state_.frame_times.erase(state_.frame_times.begin());
  }
  a_ = a;
  b_ = b;
  state_.differing.reset();
  if (is_pair(a_, b_) && !a_->is_preview) state_.differing = count_differing(a_->image, b_->image);
  picture_changed_ = true;
}

void Viewer::compose_picture() {
  if (state_.display.mode == DisplayMode::flicker && seconds(last_flicker_, Clock::now()) > flicker_seconds) {
    last_flicker_ = Clock::now();
    state_.display.flicker_b = !state_.display.flicker_b;
    picture_changed_ = true;
  }
  if (!picture_changed_ || (!a_ && !b_)) return;
  picture_changed_ = false;
  const pathtracer::Image& a = a_ ? a_->image : b_->image;
  const bool pair = b_ && b_->image.pixels.size() == a.pixels.size();
  const Picture picture =
      pair ? compose(a, b_->image, classes_.get(), state_.display) : displayed(a, state_.display.tone);
  picture_size_ = glm::ivec2(picture.width, picture.height);
  window_.show(picture);
}

std::string Viewer::title() const {
  std::string text = fmt::format("{} - Tandem", state_.scene_file.filename().string());
  for (std::size_t i = 0; i < devices_.size(); ++i) {
    const DeviceState& device = devices_[i];
    fmt::format_to(std::back_inserter(text), " | {} ", device.name);
    switch (device.activity) {
      case Activity::opening:
        text += "opening";
        break;
      case Activity::compiling:
        text += "compiling";
        break;
      case Activity::failed:
        text += "failed";
        break;
      case Activity::rendering:
      case Activity::finished: {
        const FrameHandle& frame = i == 0 ? a_ : b_;  // what is shown
        text += !frame || frame->is_preview ? std::string("preview") : fmt::format("{} spp", frame->samples);
        break;
      }
    }
  }
  if (!state_.two_devices()) return text;
  text += fmt::format(" | {}", name_of(display_mode_names(), state_.display.mode));
  if (state_.differing) text += fmt::format(" | {} pixels differ", *state_.differing);
  return text;
}

void Viewer::run() {
  Clock::time_point last = Clock::now();
  constexpr double longest_wait = 1.0 / 30;
  while (window_.begin_frame(longest_wait)) {
    const Clock::time_point now = Clock::now();
    walk_by_keys(seconds(last, now));
    last = now;
    finish_task();
    take_frames();
    const glm::ivec2 size = window_.size();
    if (state_.panel) draw_panel(state_, devices_, {size.x - panel_width, 0}, {panel_width, size.y});
    draw_path(state_);
    answer_wants();
    compose_picture();
    window_.set_title(title());
    const Placement where = placement();
    draw_line(state_, where.offset, where.size);
    window_.end_frame(where.offset, where.size);
  }
}

}  // namespace

void run_viewer(const Host& host, const ViewerOptions& options, compare::Job job) {
  Viewer viewer(host, options, std::move(job));
  viewer.run();
}

}  // namespace tandem::view
