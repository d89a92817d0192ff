#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "pathtracer/image/image.hpp"
#include "pathtracer/render/renderer.hpp"
#include "pathtracer/render/tracing_mode.hpp"
#include "rhi/device.hpp"
#include "tools/view/view.hpp"

/// The same view on one device or more, each rendering in a thread of its own.
namespace tandem::view {

/// A picture that a device has finished. Pictures of two devices with equal `revision`, `frame` and `is_preview` are of
/// the same view and the same samples.
struct Frame {
  std::uint64_t revision = 0;  ///< of the view
  std::uint32_t frame = 0;     ///< since the view changed, from 1 on; 0 for the preview
  bool is_preview = false;
  std::uint32_t samples = 0;  ///< per pixel
  pathtracer::Image image;
  double milliseconds = 0;  ///< that this frame took, by the host's clock
  double rays = 0;          ///< that it traced
  pathtracer::ImageMetadata metadata = {};
};
using FrameHandle = std::shared_ptr<const Frame>;

enum class Activity {
  opening,    ///< the device, and the scene on it
  compiling,  ///< shaders
  rendering,
  finished,  ///< the picture has all its samples
  failed
};

/// What a device is doing.
struct DeviceState {
  Activity activity = Activity::opening;
  std::string name;   ///< as given
  std::string error;  ///< of a device that failed: one sentence
  FrameHandle frame;  ///< the last one; null before the first
};

struct DeviceChoice {
  std::string name;
  std::optional<pathtracer::TracingMode> trace;
};

/// Renders a scene until it is destroyed, which waits for whatever a driver is compiling.
///
/// A change of the view cancels what is being rendered. Devices go on frame by frame together, so that there is always
/// a pair to compare; only one that still compiles, or failed, is not waited for.
class LiveRendering {
 public:
  using OpenDevice = std::function<rhi::DeviceHandle(const std::string& name)>;

  /// Returns at once. @param open is called in the devices' threads  @param notify likewise, when there is news
  LiveRendering(std::shared_ptr<const pathtracer::Scene> scene, const std::vector<DeviceChoice>& devices, View view,
                OpenDevice open, std::function<void()> notify = {});
  LiveRendering(const LiveRendering&) = delete;
  LiveRendering& operator=(const LiveRendering&) = delete;
  ~LiveRendering();

  /// Shows another view from now on. @param moving only previews until the next call: more changes are to come
  void show(View view, bool moving);

  std::vector<DeviceState> states() const;

  /// Tells the threads to end soon, and waits for none.
  void stop();
  /// Whether all threads have ended, so that the destructor waits for nothing.
  bool has_ended() const;

 private:
  struct Worker {
    DeviceChoice choice;
    DeviceState state = {};
    std::uint64_t revision = 0;  ///< of what it works at
    std::uint32_t frame = 0;     ///< finished of this revision
    bool has_ended = false;
    std::thread thread = {};
  };

  void run(Worker& worker);
  void render_views(Worker& worker, pathtracer::Renderer& renderer);
  void show_preview(Worker& worker, pathtracer::Renderer& renderer, std::uint64_t revision);
  void render_frame(Worker& worker, pathtracer::Renderer& renderer, const View& view, std::uint64_t revision);
  void set_activity(Worker& worker, Activity activity, const std::string& error = {});
  void publish(Worker& worker, Frame frame, bool finished);
  bool is_current(std::uint64_t revision) const;
  bool may_go_on(const Worker& worker) const;

  std::shared_ptr<const pathtracer::Scene> scene_;
  OpenDevice open_;
  std::function<void()> notify_;
  mutable std::mutex mutex_;  ///< of all below
  std::condition_variable changed_;
  View view_;
  std::uint64_t revision_ = 1;
  std::uint64_t light_revision_ = 1;  ///< of the view's lights
  bool moving_ = false;
  bool stopped_ = false;
  std::vector<std::unique_ptr<Worker>> workers_;
};

}  // namespace tandem::view
