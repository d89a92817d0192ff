#include "tools/view/live_rendering.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "tools/view/preview.hpp"

namespace tandem::view {
namespace {

using Clock = std::chrono::steady_clock;

/// Between two looks at whether the view has changed.
constexpr double submission_seconds = 0.03;

bool same(const pathtracer::PunctualLight& a, const pathtracer::PunctualLight& b) {
  return a.kind == b.kind && a.position == b.position && a.direction == b.direction && a.radiance == b.radiance &&
         a.inner_angle == b.inner_angle && a.outer_angle == b.outer_angle;
}

double milliseconds_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

}  // namespace

LiveRendering::LiveRendering(std::shared_ptr<const pathtracer::Scene> scene, const std::vector<DeviceChoice>& devices,
                             View view, OpenDevice open, std::function<void()> notify)
    : scene_(std::move(scene)), open_(std::move(open)), notify_(std::move(notify)), view_(std::move(view)) {
  for (const DeviceChoice& choice : devices) {
    workers_.push_back(std::make_unique<Worker>(Worker{.choice = choice}));
    workers_.back()->state.name = choice.name;
  }
  // All of them are there before one looks at the others.
  for (const std::unique_ptr<Worker>& worker : workers_)
    worker->thread = std::thread([this, &worker = *worker] {
      run(worker);
      const std::scoped_lock lock(mutex_);
      worker.has_ended = true;
    });
}

LiveRendering::~LiveRendering() {
  stop();
  for (const std::unique_ptr<Worker>& worker : workers_) worker->thread.join();
}

void LiveRendering::stop() {
  const std::scoped_lock lock(mutex_);
  stopped_ = true;
  changed_.notify_all();
}

bool LiveRendering::has_ended() const {
  const std::scoped_lock lock(mutex_);
  return std::ranges::all_of(workers_, [](const auto& worker) { return worker->has_ended; });
}

void LiveRendering::show(View view, bool moving) {
  const std::scoped_lock lock(mutex_);
  ++revision_;
  if (!std::ranges::equal(view.lights, view_.lights, same)) light_revision_ = revision_;
  view_ = std::move(view);
  moving_ = moving;
  changed_.notify_all();
}

std::vector<DeviceState> LiveRendering::states() const {
  const std::scoped_lock lock(mutex_);
  std::vector<DeviceState> states;
  for (const std::unique_ptr<Worker>& worker : workers_) states.push_back(worker->state);
  return states;
}

bool LiveRendering::is_current(std::uint64_t revision) const {
  const std::scoped_lock lock(mutex_);
  return !stopped_ && revision == revision_;
}

/// Whether no other device has fewer frames of the view; the mutex is held.
bool LiveRendering::may_go_on(const Worker& worker) const {
  return std::ranges::all_of(workers_, [&](const std::unique_ptr<Worker>& other) {
    const bool renders = other->state.activity == Activity::rendering || other->state.activity == Activity::finished;
    if (other.get() == &worker || !renders) return true;
    return other->revision == revision_ && other->frame >= worker.frame;
  });
}

void LiveRendering::set_activity(Worker& worker, Activity activity, const std::string& error) {
  {
    const std::scoped_lock lock(mutex_);
    worker.state.activity = activity;
    worker.state.error = error;
    changed_.notify_all();
  }
  if (notify_) notify_();
}

void LiveRendering::publish(Worker& worker, Frame frame, bool finished) {
  {
    const std::scoped_lock lock(mutex_);
    worker.frame = frame.frame;
    worker.state.frame = std::make_shared<const Frame>(std::move(frame));
    worker.state.activity = finished ? Activity::finished : Activity::rendering;
    changed_.notify_all();
  }
  if (notify_) notify_();
}

void LiveRendering::run(Worker& worker) {
  try {
    const rhi::DeviceHandle device = open_(worker.choice.name);
    View view;
    {
      const std::scoped_lock lock(mutex_);
      if (stopped_) return;
      view = view_;
    }
    view.settings.submission_seconds = submission_seconds;
    pathtracer::Renderer renderer(device, *scene_, view.settings, worker.choice.trace);
    render_views(worker, renderer);
  } catch (const std::exception& error) {
    set_activity(worker, Activity::failed, error.what());
  }
}

void LiveRendering::render_views(Worker& worker, pathtracer::Renderer& renderer) {
  std::uint64_t lights = 1;  // the revision of those on the device
  for (;;) {
    View view;
    std::uint64_t revision = 0;
    bool new_lights = false, begins = false, moving = false;
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [&] {
        if (stopped_ || worker.revision != revision_) return true;
        return !moving_ && worker.state.activity != Activity::finished && may_go_on(worker);
      });
      if (stopped_) return;
      begins = worker.revision != revision_;
      if (begins) worker.frame = 0;
      worker.revision = revision = revision_;
      view = view_;
      moving = moving_;
      new_lights = lights != light_revision_;
      lights = light_revision_;
      if (begins && worker.state.activity == Activity::finished) worker.state.activity = Activity::rendering;
      changed_.notify_all();
    }
    view.settings.submission_seconds = submission_seconds;
    if (begins) {
      // The view may need other shaders than the last one.
      if (!moving || worker.state.activity == Activity::opening) set_activity(worker, Activity::compiling);
      if (new_lights) renderer.set_lights(view.lights);
      renderer.restart(view.settings);
      show_preview(worker, renderer, revision);
      if (moving) continue;
      renderer.warm_up();
      set_activity(worker, Activity::rendering);
      continue;  // the others may be further
    }
    render_frame(worker, renderer, view, revision);
  }
}

void LiveRendering::show_preview(Worker& worker, pathtracer::Renderer& renderer, std::uint64_t revision) {
  const Clock::time_point start = Clock::now();
  Frame frame{.revision = revision, .is_preview = true, .image = preview(renderer.scene())};
  frame.milliseconds = milliseconds_since(start);
  frame.rays = static_cast<double>(frame.image.pixels.size());
  {
    const std::scoped_lock lock(mutex_);
    worker.state.frame = std::make_shared<const Frame>(std::move(frame));
  }
  if (notify_) notify_();
}

/// Nothing when the view changes meanwhile.
void LiveRendering::render_frame(Worker& worker, pathtracer::Renderer& renderer, const View& view,
                                 std::uint64_t revision) {
  const Clock::time_point start = Clock::now();
  const pathtracer::AccumulationSettings& accumulation = view.accumulation;
  if (!accumulation.accumulate) {
    // The frames of every device have the same random numbers.
    pathtracer::RenderSettings settings = view.settings;
    settings.seed += worker.frame;
    renderer.restart(settings);
  }
  const std::uint32_t missing = accumulation.maximum_samples - renderer.samples();
  const double rays_before = static_cast<double>(renderer.ray_count());
  const std::uint32_t samples = std::min(accumulation.samples_per_frame, missing);
  // A cancelled picture is empty, and the next view empties it anyway.
  if (!renderer.render(samples, [&](double) { return is_current(revision); })) return;
  const bool finished = accumulation.accumulate && renderer.samples() >= accumulation.maximum_samples;
  publish(worker,
          {.revision = revision,
           .frame = worker.frame + 1,
           .samples = renderer.samples(),
           .image = renderer.image(),
           .milliseconds = milliseconds_since(start),
           .rays = static_cast<double>(renderer.ray_count()) - rays_before,
           .metadata = renderer.metadata()},
          finished);
}

}  // namespace tandem::view
