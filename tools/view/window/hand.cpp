// What the mouse and the keys that are held down do to the camera.

#include "tools/view/window/viewer_loop.hpp"

#include <algorithm>
#include <cmath>

#include <GLFW/glfw3.h>
#include <glm/geometric.hpp>

#include "tools/view/camera_controls.hpp"

namespace tandem::view {
namespace {

/// As large as fits, pixel by pixel where it is not to be smaller.
Placement place(glm::ivec2 room, glm::ivec2 picture) {
  Placement placement;
  placement.scale = std::min(double(room.x) / picture.x, double(room.y) / picture.y);
  if (placement.scale >= 1) placement.scale = std::floor(placement.scale);
  placement.size = glm::max(glm::ivec2(glm::dvec2(picture) * placement.scale), glm::ivec2(1));
  placement.offset = (room - placement.size) / 2;
  return placement;
}

}  // namespace

Placement ViewerLoop::placement() const {
  const glm::ivec2 size = window_.size();
  return place(glm::max(glm::ivec2(size.x - (state_.panel ? panel_width : 0), size.y), glm::ivec2(1)), picture_size_);
}

void ViewerLoop::press(int button, bool pressed, int modifiers, glm::dvec2 position) {
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

void ViewerLoop::move(glm::dvec2 position) {
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

void ViewerLoop::change_camera(const pathtracer::Camera& camera) {
  if (camera == *state_.view.settings.camera) return;
  state_.view.settings.camera = camera;
  state_.wants.view = state_.wants.moving = true;
}

void ViewerLoop::walk_by_keys(double elapsed) {
  // Of ctrl+S, control may be up before S is.
  constexpr auto release_time = std::chrono::milliseconds(300);
  if (window_.is_pressed(GLFW_KEY_LEFT_CONTROL) || window_.is_pressed(GLFW_KEY_RIGHT_CONTROL))
    last_control_ = Clock::now();
  if (Clock::now() - last_control_ < release_time) return;
  const auto axis = [&](int forth, int back) {
    return double(window_.is_pressed(forth)) - double(window_.is_pressed(back));
  };
  const glm::dvec3 way(axis(GLFW_KEY_D, GLFW_KEY_A), axis(GLFW_KEY_E, GLFW_KEY_Q), axis(GLFW_KEY_W, GLFW_KEY_S));
  if (way == glm::dvec3(0)) return;
  const pathtracer::Camera& camera = *state_.view.settings.camera;
  const double speed = 0.5 * glm::distance(camera.position, camera.target);  // a second
  change_camera(walk(camera, way * (speed * std::min(elapsed, 0.1))));
}

}  // namespace tandem::view
