#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "tools/view/display.hpp"

struct GLFWwindow;

namespace tandem::view {

/// A window on the screen with an OpenGL context, Dear ImGui, and one picture in it. For the main thread.
class Window {
 public:
  /// What a hand did. Positions are in pixels from the upper left corner of the window; what the panel takes for itself
  /// is not passed on.
  struct Events {
    std::function<void(int key, int modifiers)> key;  ///< GLFW_KEY_*, GLFW_MOD_*; pressed, or repeated
    std::function<void(int button, bool pressed, int modifiers, glm::dvec2 position)> button;
    std::function<void(glm::dvec2 position)> move;
    std::function<void(double steps)> wheel;
    std::function<void(const std::filesystem::path& file)> drop;
  };

  /// Throws Error when there is no display or no OpenGL 3.
  Window(glm::ivec2 size, const std::string& title, Events events);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  /// Handles what has happened, waiting for it for a while at most, and begins a frame of Dear ImGui. False when the
  /// window is to be closed.
  bool begin_frame(double wait_seconds);
  /// Draws the picture into the rectangle and Dear ImGui over it.
  void end_frame(glm::ivec2 picture_offset, glm::ivec2 picture_size);
  void show(const Picture& picture);
  void set_title(const std::string& title);
  void close();
  /// Ends what begin_frame waits for. From any thread.
  static void wake();
  glm::ivec2 size() const;
  bool is_pressed(int key) const;
  GLFWwindow* handle() const noexcept { return window_; }
  const Events& events() const noexcept { return events_; }

 private:
  GLFWwindow* window_ = nullptr;
  Events events_;
  unsigned texture_ = 0;
  std::string title_;
};

}  // namespace tandem::view
