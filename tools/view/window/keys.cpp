#include <algorithm>
#include <array>

#include <GLFW/glfw3.h>

#include "tools/view/camera_controls.hpp"
#include "tools/view/window/state.hpp"

namespace tandem::view {
namespace {

/// A light at the camera, as bright as a white surface at the target would have to be.
pathtracer::PunctualLight light_at(const pathtracer::Camera& camera) {
  const glm::vec3 way = camera.target - camera.position;
  return {.kind = pathtracer::LightKind::point,
          .position = camera.position,
          .direction = way,
          .radiance = glm::vec3(way.x * way.x + way.y * way.y + way.z * way.z)};
}

void scale_light(State& state, float factor) {
  if (state.light >= state.view.lights.size()) return;
  state.view.lights[state.light].radiance *= factor;
  state.wants.view = true;
}

std::string next_device(const State& state, const std::string& name, bool none) {
  std::vector<std::string> names = state.devices;
  if (none) names.emplace_back();
  auto found = std::ranges::find(names, name);
  if (found == names.end() || ++found == names.end()) found = names.begin();
  return *found;
}

}  // namespace

const std::vector<Shortcut>& shortcuts() {
  static const std::vector<Shortcut> all = {
      {"left button", "orbit"},
      {"wheel, right button", "dolly"},
      {"ctrl+left, middle button", "pan"},
      {"alt+left", "look around"},
      {"W A S D, E Q", "walk, up and down"},
      {"click", "explain the pixel"},
      {"1 to 7", "a, b, split, side by side, flicker, difference, classes"},
      {"[ ]", "move the line of split"},
      {"- +", "exposure"},
      {"T", "tone map"},
      {"space", "accumulation on, off"},
      {"R", "begin the picture anew"},
      {"Home", "the scene's camera"},
      {"N, Delete", "add, remove a light"},
      {"J K", "light darker, brighter"},
      {"F2, F3", "next device a, b"},
      {"C", "classes of the differences"},
      {"ctrl+S", "save picture and scene"},
      {"ctrl+R", "write the report"},
      {"F10", "hide the panel"},
      {"ctrl+Q", "close"},
  };
  return all;
}

void press_key(State& state, int key, int modifiers) {
  View& view = state.view;
  auto& wants = state.wants;
  if ((modifiers & GLFW_MOD_CONTROL) != 0) {
    if (key == GLFW_KEY_S) wants.save = true;
    if (key == GLFW_KEY_R) wants.report = true;
    if (key == GLFW_KEY_Q) wants.close = true;
    return;
  }
  if (key >= GLFW_KEY_1 && key <= GLFW_KEY_7) {
    state.display.mode = static_cast<DisplayMode>(key - GLFW_KEY_1);
    wants.display = true;
    if (state.display.mode == DisplayMode::classes) wants.classes = true;
    return;
  }
  const auto split = [&](float step) {
    state.display.split = std::clamp(state.display.split + step, 0.0f, 1.0f);
    wants.display = true;
  };
  const auto expose = [&](double stops) {
    state.display.tone.exposure += stops;
    wants.display = true;
  };
  switch (key) {
    case GLFW_KEY_LEFT_BRACKET:
      return split(-0.0625f);
    case GLFW_KEY_RIGHT_BRACKET:
      return split(0.0625f);
    case GLFW_KEY_MINUS:
    case GLFW_KEY_KP_SUBTRACT:
      return expose(-0.5);
    case GLFW_KEY_EQUAL:
    case GLFW_KEY_KP_ADD:
      return expose(0.5);
    case GLFW_KEY_T: {
      const auto names = pathtracer::tone_curve_names();
      const auto next = (static_cast<std::size_t>(state.display.tone.curve) + 1) % names.size();
      state.display.tone.curve = static_cast<pathtracer::ToneCurve>(next);
      wants.display = true;
      return;
    }
    case GLFW_KEY_SPACE:
      view.accumulation.accumulate = !view.accumulation.accumulate;
      wants.view = true;
      return;
    case GLFW_KEY_R:
      wants.view = true;
      return;
    case GLFW_KEY_HOME:
      view.settings.camera = state.first_camera;
      wants.view = true;
      return;
    case GLFW_KEY_N:
      view.lights.push_back(light_at(*view.settings.camera));
      state.light = view.lights.size() - 1;
      wants.view = true;
      return;
    case GLFW_KEY_DELETE:
      if (state.light >= view.lights.size()) return;
      view.lights.erase(view.lights.begin() + static_cast<std::ptrdiff_t>(state.light));
      state.light = 0;
      wants.view = true;
      return;
    case GLFW_KEY_J:
      return scale_light(state, 0.5f);
    case GLFW_KEY_K:
      return scale_light(state, 2.0f);
    case GLFW_KEY_F2:
      state.a.name = next_device(state, state.a.name, false);
      wants.devices = true;
      return;
    case GLFW_KEY_F3:
      state.b.name = next_device(state, state.b.name, true);
      wants.devices = true;
      return;
    case GLFW_KEY_C:
      wants.classes = true;
      return;
    case GLFW_KEY_F10:
      state.panel = !state.panel;
      return;
    case GLFW_KEY_ESCAPE:
      state.path_text.clear();
      return;
    default:
      return;
  }
}

}  // namespace tandem::view
