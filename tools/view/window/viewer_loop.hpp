#pragma once

#include <chrono>
#include <functional>
#include <future>
#include <memory>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "tools/view/live_rendering.hpp"
#include "tools/view/window/state.hpp"
#include "tools/view/window/viewer.hpp"
#include "tools/view/window/window.hpp"

namespace tandem::view {

using Clock = std::chrono::steady_clock;

inline constexpr int panel_width = 330;  ///< pixels

/// Where the picture is in the window.
struct Placement {
  glm::ivec2 offset{0}, size{1};
  double scale = 1;
};

/// What a task in the background ends with: it is to be shown in a window of its own, or as a message.
struct TaskResult {
  std::string message;
  std::string path_text = {};
  std::shared_ptr<const pathtracer::Image> classes = {};
};

/// The window with all that goes on behind it: what run_viewer runs. For the main thread.
class ViewerLoop {
 public:
  ViewerLoop(const Host& host, const ViewerOptions& options, compare::Job job);
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
  Clock::time_point last_control_{};  ///< when the control key was last seen down

  int button_ = -1;  ///< that is down in the picture
  int modifiers_ = 0;
  glm::dvec2 pressed_at_{0}, last_position_{0};
  bool dragged_ = false, drags_line_ = false;
};

}  // namespace tandem::view
