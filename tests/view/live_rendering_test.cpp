#include "tools/view/live_rendering.hpp"

#include <doctest/doctest.h>

#include <chrono>
#include <cstring>

#include "devices/devices.hpp"
#include "pathtracer/load/scene_loader.hpp"
#include "tools/view/camera_controls.hpp"
#include "tools/view/display.hpp"

namespace tandem::view {
namespace {

rhi::DeviceHandle open(const std::string& name) {
  rhi::DeviceDesc desc;
  desc.name = name;
  desc.robust_access = false;
  return create_device(desc);
}

std::shared_ptr<const pathtracer::Scene> box() {
  static const auto scene = std::make_shared<const pathtracer::Scene>(
      pathtracer::load_scene(TANDEM_SOURCE_DIRECTORY "/scenes/cornell_box.obj"));
  return scene;
}

View small_view() {
  View view;
  view.settings.width = 24;
  view.settings.height = 16;
  view.settings.max_depth = 3;
  view.settings.camera = pathtracer::automatic_camera(*box(), 1.5f);
  view.accumulation = {.samples_per_frame = 1, .maximum_samples = 4, .accumulate = true};
  return view;
}

/// Waits, for a minute at most, until the states are as they should be; the minute is for machines that do much else.
template <typename Condition>
std::vector<DeviceState> wait_for(const LiveRendering& rendering, Condition condition) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  for (;;) {
    std::vector<DeviceState> states = rendering.states();
    if (condition(states)) return states;
    REQUIRE(std::chrono::steady_clock::now() < end);
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
}

bool all_finished(const std::vector<DeviceState>& states) {
  return std::ranges::all_of(states, [](const DeviceState& s) { return s.activity == Activity::finished; });
}

pathtracer::Image rendered(const View& view, std::uint32_t samples) {
  pathtracer::Renderer renderer(open("cpu"), *box(), view.settings);
  if (!view.lights.empty()) renderer.set_lights(view.lights);
  renderer.render(samples);
  return renderer.image();
}

TEST_CASE("two devices arrive at the picture that a renderer makes") {
  const View view = small_view();
  LiveRendering rendering(box(), {{"cpu", {}}, {"cpu-exact", {}}}, view, open);
  const std::vector<DeviceState> states = wait_for(rendering, all_finished);
  const pathtracer::Image expected = rendered(view, 4);
  for (const DeviceState& state : states) {
    CHECK(state.frame->samples == 4);
    CHECK(state.frame->rays > 0);
  }
  CHECK(count_differing(states[0].frame->image, expected) == 0);
}

TEST_CASE("a new view begins anew, with its lights") {
  View view = small_view();
  LiveRendering rendering(box(), {{"cpu", {}}}, view, open);
  wait_for(rendering, all_finished);
  view.settings.camera = orbit(*view.settings.camera, {0.3, 0.1});
  view.lights.push_back({.position = view.settings.camera->position, .radiance = glm::vec3(3)});
  rendering.show(view, false);
  const auto states = wait_for(
      rendering, [](const auto& s) { return s[0].frame->revision == 2 && s[0].activity == Activity::finished; });
  CHECK(count_differing(states[0].frame->image, rendered(view, 4)) == 0);
}

TEST_CASE("while the view moves there are previews only") {
  View view = small_view();
  view.accumulation.maximum_samples = 1u << 24;  // never finished
  LiveRendering rendering(box(), {{"cpu", {}}}, view, open);
  for (int i = 0; i < 5; ++i) {
    view.settings.camera = orbit(*view.settings.camera, {0.1, 0});
    rendering.show(view, true);
  }
  auto states = wait_for(rendering, [](const auto& s) { return s[0].frame && s[0].frame->revision == 6; });
  CHECK(states[0].frame->is_preview);
  CHECK(states[0].frame->samples == 0);
  rendering.show(view, false);
  wait_for(rendering, [](const auto& s) { return s[0].frame->revision == 7 && s[0].frame->samples > 2; });
}

TEST_CASE("frames that do not accumulate have the same random numbers on both devices") {
  View view = small_view();
  view.accumulation.accumulate = false;
  LiveRendering rendering(box(), {{"cpu", {}}, {"cpu", {}}}, view, open);
  const auto states = wait_for(rendering, [](const auto& s) {
    return s[0].frame && s[1].frame && s[0].frame->frame == s[1].frame->frame && s[0].frame->frame > 2;
  });
  CHECK(states[0].frame->samples == 1);
  CHECK(count_differing(states[0].frame->image, states[1].frame->image) == 0);
  view.settings.seed += states[0].frame->frame - 1;
  CHECK(count_differing(states[0].frame->image, rendered(view, 1)) == 0);
}

TEST_CASE("a device that fails says why, and the other goes on") {
  LiveRendering rendering(box(), {{"cpu", {}}, {"vulkan:99", {}}}, small_view(), open);
  const auto states = wait_for(rendering, [](const auto& s) {
    return s[0].activity == Activity::finished && s[1].activity == Activity::failed;
  });
  CHECK(states[1].error.find("vulkan:99") != std::string::npos);
}

}  // namespace
}  // namespace tandem::view
