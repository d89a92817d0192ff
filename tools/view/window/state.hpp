#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "pathtracer/scene/scene.hpp"
#include "tools/view/display.hpp"
#include "tools/view/live_rendering.hpp"
#include "tools/view/view.hpp"

namespace tandem::view {

/// What the window shows and how, as keys, the mouse and the panel change it. What they ask for that takes time they
/// note in `wants`, for the loop of the viewer to do.
struct State {
  std::filesystem::path scene_file;
  std::shared_ptr<const pathtracer::Scene> scene;
  View view;
  pathtracer::Camera first_camera;            ///< that the scene came with
  DeviceChoice a, b;                          ///< b without a name: there is one device
  std::vector<std::string> devices;           ///< names of those that are there
  std::vector<std::filesystem::path> scenes;  ///< beside the one that is shown
  Display display;
  bool panel = true;
  bool two_devices() const { return !b.name.empty(); }

  struct {
    bool view = false;     ///< another picture
    bool moving = false;   ///< and more changes to come at once
    bool display = false;  ///< the same picture, shown in another way
    bool devices = false;
    std::optional<std::filesystem::path> scene;
    std::optional<glm::uvec2> explain;  ///< a pixel
    bool save = false;
    bool report = false;
    bool classes = false;
    bool close = false;
  } wants;

  // What is shown only.
  std::vector<float> frame_times;  ///< milliseconds, the latest last
  double rays_per_second = 0;
  std::string message;                     ///< the last thing that was done
  std::string path_text;                   ///< about a pixel; empty: its window is closed
  std::optional<std::uint64_t> differing;  ///< pixels, of the pictures shown
  std::size_t light = 0;                   ///< the one that the panel and keys change
};

/// Does what a key stands for: the table of shortcuts().
void press_key(State& state, int key, int modifiers);

struct Shortcut {
  const char* keys;
  const char* action;
};
/// What hands can do, for the panel and the help.
const std::vector<Shortcut>& shortcuts();

/// Draws the panel into the rectangle. Reads and changes the state.
void draw_panel(State& state, const std::vector<DeviceState>& devices, glm::ivec2 offset, glm::ivec2 size);
/// Draws the line of split over the picture in the rectangle.
void draw_line(const State& state, glm::ivec2 offset, glm::ivec2 size);
/// The window with the path of a pixel, if there is one.
void draw_path(State& state);

}  // namespace tandem::view
