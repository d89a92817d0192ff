#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <string_view>
#include <type_traits>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "tools/view/window/state.hpp"

namespace tandem::view {
namespace {

using pathtracer::CameraKind;
using pathtracer::LightKind;

/// A choice among named values. True when it has changed.
template <typename T>
bool combo(const char* label, T& value, std::span<const Named<std::type_identity_t<T>>> names) {
  bool changed = false;
  if (!ImGui::BeginCombo(label, name_of<T>(names, value))) return false;
  for (const Named<T>& named : names)
    if (ImGui::Selectable(named.name, named.value == value) && !(named.value == value)) {
      value = named.value;
      changed = true;
    }
  ImGui::EndCombo();
  return changed;
}

bool whole_number(const char* label, std::uint32_t& value, int least, int most) {
  int number = static_cast<int>(value);
  if (!ImGui::InputInt(label, &number)) return false;
  number = std::clamp(number, least, most);
  if (static_cast<std::uint32_t>(number) == value) return false;
  value = static_cast<std::uint32_t>(number);
  return true;
}

bool drag(const char* label, float& value, float speed, float least, float most) {
  if (!ImGui::DragFloat(label, &value, speed, least, most)) return false;
  value = std::isfinite(value) ? std::clamp(value, least, most) : least;
  return true;
}

float reach(const State& state) {
  return glm::distance(state.view.settings.camera->position, state.view.settings.camera->target);
}

void draw_device(State& state, const char* label, DeviceChoice& choice, const std::vector<DeviceState>& devices,
                 std::size_t index, bool optional) {
  if (ImGui::BeginCombo(label, choice.name.empty() ? "none" : choice.name.c_str())) {
    std::vector<std::string> names = state.devices;
    if (optional) names.insert(names.begin(), "");
    for (const std::string& name : names)
      if (ImGui::Selectable(name.empty() ? "none" : name.c_str(), name == choice.name) && name != choice.name) {
        choice.name = name;
        state.wants.devices = true;
      }
    ImGui::EndCombo();
  }
  if (choice.name.empty()) return;
  static constexpr Named<std::optional<pathtracer::TracingMode>> forms[] = {
      {std::nullopt, "automatic"},
      {pathtracer::TracingMode::query, "query"},
      {pathtracer::TracingMode::pipeline, "pipeline"}};
  if (combo(fmt::format("tracing {}", label).c_str(), choice.trace, forms)) state.wants.devices = true;
  if (index >= devices.size()) return;
  const DeviceState& device = devices[index];
  switch (device.activity) {
    case Activity::opening:
      return ImGui::TextUnformatted("uploading the scene");
    case Activity::compiling:
      return ImGui::TextUnformatted("compiling shaders");
    case Activity::failed:
      return ImGui::TextWrapped("%s", device.error.c_str());
    default:
      break;
  }
  if (device.frame)
    ImGui::Text("%u spp, %.1f ms, %.2f Mrays/s", device.frame->samples, device.frame->milliseconds,
                device.frame->rays / std::max(device.frame->milliseconds, 1e-3) / 1000);
}

void draw_display(State& state) {
  Display& display = state.display;
  bool changed = false;
  if (state.two_devices()) {
    changed |= combo("show", display.mode, display_mode_names());
    if (changed && display.mode == DisplayMode::classes) state.wants.classes = true;
    if (state.differing)
      ImGui::Text("%llu pixels differ", static_cast<unsigned long long>(*state.differing));
    else
      ImGui::TextUnformatted("no two pictures of the same samples yet");
  }
  auto exposure = static_cast<float>(display.tone.exposure);
  if (drag("exposure", exposure, 0.05f, -30, 30)) {
    display.tone.exposure = exposure;
    changed = true;
  }
  changed |= combo("tone map", display.tone.curve, pathtracer::tone_curve_names());
  state.wants.display |= changed;
}

bool draw_sampling(State& state) {
  pathtracer::RenderSettings& settings = state.view.settings;
  pathtracer::AccumulationSettings& accumulation = state.view.accumulation;
  bool changed = whole_number("samples/frame", accumulation.samples_per_frame, 1, 1024);
  if (whole_number("samples at most", accumulation.maximum_samples, 1, 1 << 24)) {
    settings.planned_samples = accumulation.maximum_samples;
    changed = true;
  }
  changed |= ImGui::Checkbox("accumulate", &accumulation.accumulate);
  ImGui::SameLine();
  changed |= ImGui::Button("reset");
  changed |= whole_number("depth", settings.max_depth, 1, 64);
  changed |= combo("integrator", settings.integrator, pathtracer::integrator_names());
  changed |= combo("sampler", settings.sampler, pathtracer::sampler_names());
  return changed;
}

bool draw_camera(State& state) {
  pathtracer::Camera& camera = *state.view.settings.camera;
  bool changed = false;
  CameraKind kind = camera.kind;
  if (combo("kind", kind, pathtracer::camera_names())) {
    // What the target shows keeps its size.
    if (kind == CameraKind::orthographic)
      camera.height = 2 * reach(state) * std::tan(glm::radians(camera.vertical_fov) / 2);
    camera.kind = kind;
    changed = true;
  }
  if (camera.kind == CameraKind::orthographic)
    changed |= drag("height", camera.height, reach(state) / 200, 1e-6f, 1e9f);
  if (camera.kind != CameraKind::perspective) return changed;
  changed |= drag("field of view", camera.vertical_fov, 0.2f, 1, 170);
  changed |= drag("lens radius", camera.lens_radius, reach(state) / 5000, 0, 1e9f);
  changed |= drag("focus (0: target)", camera.focus_distance, reach(state) / 500, 0, 1e9f);
  return changed;
}

bool draw_light(State& state) {
  std::vector<pathtracer::PunctualLight>& lights = state.view.lights;
  if (ImGui::Button("add")) press_key(state, 'N', 0);
  if (lights.empty()) return false;
  state.light = std::min(state.light, lights.size() - 1);
  ImGui::SameLine();
  if (ImGui::Button("remove")) {
    lights.erase(lights.begin() + static_cast<std::ptrdiff_t>(state.light));
    state.light = 0;
    return true;
  }
  int index = static_cast<int>(state.light);
  if (ImGui::SliderInt("light", &index, 0, static_cast<int>(lights.size()) - 1))
    state.light = static_cast<std::size_t>(std::clamp(index, 0, static_cast<int>(lights.size()) - 1));
  if (lights.empty()) return true;
  pathtracer::PunctualLight& light = lights[state.light];
  static constexpr Named<LightKind> kinds[] = {
      {LightKind::point, "point"}, {LightKind::spot, "spot"}, {LightKind::directional, "directional"}};
  bool changed = combo("type", light.kind, kinds);
  if (light.kind != LightKind::directional)
    changed |= ImGui::DragFloat3("position", &light.position.x, reach(state) / 200);
  if (light.kind != LightKind::point) {
    glm::vec3 direction = light.direction;
    // A light shines somewhere.
    if (ImGui::DragFloat3("direction", &direction.x, 0.01f) && glm::length(direction) > 1e-3f) {
      light.direction = direction;
      changed = true;
    }
  }
  float intensity = std::max({light.radiance.x, light.radiance.y, light.radiance.z});
  glm::vec3 color = intensity > 0 ? light.radiance / intensity : glm::vec3(1);
  bool radiance_changed = drag("intensity", intensity, std::max(intensity, 0.01f) / 100, 0, 1e6f);
  radiance_changed |= ImGui::ColorEdit3("colour", &color.x, ImGuiColorEditFlags_Float);
  if (radiance_changed) light.radiance = glm::max(color, glm::vec3(0)) * intensity;
  changed |= radiance_changed;
  if (light.kind == LightKind::spot) {
    changed |= drag("outer angle", light.outer_angle, 0.2f, 1, 90);
    changed |= drag("inner angle", light.inner_angle, 0.2f, 0, 89);
    light.inner_angle = std::min(light.inner_angle, light.outer_angle - 0.5f);
  }
  return changed;
}

bool draw_background(State& state) {
  std::optional<glm::vec3>& background = state.view.settings.background;
  bool own = background.has_value();
  bool changed = ImGui::Checkbox("own background", &own);
  if (changed) background = own ? std::optional(glm::vec3(0)) : std::nullopt;
  if (background) changed |= ImGui::ColorEdit3("background", &background->x, ImGuiColorEditFlags_Float);
  if (background) *background = glm::max(*background, glm::vec3(0));
  return changed;
}

}  // namespace

void draw_panel(State& state, const std::vector<DeviceState>& devices, glm::ivec2 offset, glm::ivec2 size) {
  ImGui::SetNextWindowPos(ImVec2(static_cast<float>(offset.x), static_cast<float>(offset.y)));
  ImGui::SetNextWindowSize(ImVec2(static_cast<float>(size.x), static_cast<float>(size.y)));
  ImGui::Begin(
      "panel", nullptr,
      ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoCollapse);
  ImGui::PushItemWidth(-110);
  if (ImGui::BeginCombo("scene", state.scene_file.filename().string().c_str())) {
    for (const std::filesystem::path& file : state.scenes)
      if (ImGui::Selectable(file.filename().string().c_str(), file == state.scene_file)) state.wants.scene = file;
    ImGui::EndCombo();
  }
  draw_device(state, "a", state.a, devices, 0, false);
  draw_device(state, "b", state.b, devices, 1, true);
  if (!state.frame_times.empty())
    ImGui::PlotLines("ms/frame", state.frame_times.data(), static_cast<int>(state.frame_times.size()), 0, nullptr, 0,
                     *std::ranges::max_element(state.frame_times), ImVec2(0, 36));
  const auto section = [](const char* name) { return ImGui::CollapsingHeader(name, ImGuiTreeNodeFlags_DefaultOpen); };
  bool changed = false;
  if (section("display")) draw_display(state);
  if (section("sampling")) changed |= draw_sampling(state);
  if (section("camera")) changed |= draw_camera(state);
  if (section("lights")) changed |= draw_light(state);
  if (section("background")) changed |= draw_background(state);
  if (changed) state.wants.view = true;
  if (ImGui::Button("save")) state.wants.save = true;
  if (state.two_devices()) {
    ImGui::SameLine();
    if (ImGui::Button("report")) state.wants.report = true;
  }
  if (!state.message.empty()) ImGui::TextWrapped("%s", state.message.c_str());
  if (ImGui::CollapsingHeader("keys"))
    for (const Shortcut& shortcut : shortcuts()) ImGui::TextWrapped("%s: %s", shortcut.keys, shortcut.action);
  ImGui::PopItemWidth();
  ImGui::End();
}

void draw_line(const State& state, glm::ivec2 offset, glm::ivec2 size) {
  if (!state.two_devices() || state.display.mode != DisplayMode::split) return;
  const float x = static_cast<float>(offset.x) + state.display.split * static_cast<float>(size.x);
  const auto top = static_cast<float>(offset.y), bottom = static_cast<float>(offset.y + size.y);
  ImGui::GetForegroundDrawList()->AddLine(ImVec2(x, top), ImVec2(x, bottom), IM_COL32(255, 255, 255, 160));
}

void draw_path(State& state) {
  if (state.path_text.empty()) return;
  bool open = true;
  ImGui::SetNextWindowSize(ImVec2(560, 360), ImGuiCond_FirstUseEver);
  if (ImGui::Begin("path of a pixel", &open, ImGuiWindowFlags_HorizontalScrollbar)) {
    std::size_t begin = 0;
    while (begin < state.path_text.size()) {
      const std::size_t end = std::min(state.path_text.find('\n', begin), state.path_text.size());
      const char* const line = state.path_text.data() + begin;
      // The table marks what differs with a star.
      const bool marked = *line == '*' || std::string_view(line, end - begin).starts_with("first difference");
      if (marked) ImGui::PushStyleColor(ImGuiCol_Text, ImVec4(1, 0.8f, 0.2f, 1));
      ImGui::TextUnformatted(line, state.path_text.data() + end);
      if (marked) ImGui::PopStyleColor();
      begin = end + 1;
    }
  }
  ImGui::End();
  if (!open) state.path_text.clear();
}

}  // namespace tandem::view
