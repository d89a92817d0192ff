#include "tools/view/window/viewer_loop.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include "tools/view/camera_controls.hpp"

namespace tandem::view {
namespace {

constexpr double settle_seconds = 0.15;  // without a change, after which a camera counts as at rest
constexpr double flicker_seconds = 0.4;

double seconds(Clock::time_point from, Clock::time_point to) {
  return std::chrono::duration<double>(to - from).count();
}

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

}  // namespace

ViewerLoop::ViewerLoop(const Host& host, const ViewerOptions& options, compare::Job job)
    : host_(&host),
      options_(options),
      state_(first_state(options)),
      window_(
          {static_cast<int>(std::clamp(job.settings.width, 160u, 2048u)) + panel_width,
           static_cast<int>(std::clamp(job.settings.height, 480u, 1400u))},
          "Tandem",
          {.key =
               [this](int key, int modifiers) {
                 if ((modifiers & GLFW_MOD_CONTROL) != 0) last_control_ = Clock::now();
                 press_key(state_, key, modifiers);
               },
           .button = [this](int button, bool pressed, int modifiers,
                            glm::dvec2 position) { press(button, pressed, modifiers, position); },
           .move = [this](glm::dvec2 position) { move(position); },
           .wheel = [this](double steps) { change_camera(dolly(*state_.view.settings.camera, std::pow(0.9, steps))); },
           .drop = [this](const std::filesystem::path& file) { state_.wants.scene = file; }}) {
  open(std::move(job));
}

void ViewerLoop::open(compare::Job job) {
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

void ViewerLoop::start_rendering() {
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

void ViewerLoop::answer_wants() {
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
void ViewerLoop::take_frames() {
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

void ViewerLoop::compose_picture() {
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

std::string ViewerLoop::title() const {
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

void ViewerLoop::run() {
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

void run_viewer(const Host& host, const ViewerOptions& options, compare::Job job) {
  ViewerLoop loop(host, options, std::move(job));
  loop.run();
}

}  // namespace tandem::view
