#include "rhi_cpu/trace/embree/embree_device.hpp"

#include <atomic>
#include <mutex>
#include <utility>

#include <fmt/format.h>

#include "rhi/error.hpp"
#include "rhi_cpu/trace/embree/embree.hpp"

namespace tandem::cpu {

struct EmbreeDevice::State {
  rhi::MessageCallback on_message;
  std::mutex mutex;
  std::string last_text;  // of the error callback; guarded by mutex
  RTCDevice device = nullptr;
  bool has_ray_masks = false;
  std::atomic<std::int64_t> allocated = 0;

  State() = default;
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  ~State() {
    if (device == nullptr) return;
    // Scenes may keep the device alive beyond this object.
    rtcSetDeviceErrorFunction(device, nullptr, nullptr);
    rtcSetDeviceMemoryMonitorFunction(device, nullptr, nullptr);
    rtcReleaseDevice(device);
  }

  static bool count_memory(void* user, ssize_t bytes, bool /*after*/) {
    static_cast<State*>(user)->allocated += bytes;
    return true;
  }

  static void report(void* user, RTCError /*error*/, const char* text) {
    State& state = *static_cast<State*>(user);
    {
      const std::lock_guard lock(state.mutex);
      state.last_text = text != nullptr ? text : "";
    }
    if (state.on_message) state.on_message({rhi::Severity::error, "embree", text != nullptr ? text : "unknown error"});
  }
};

EmbreeDevice::EmbreeDevice(rhi::MessageCallback on_message, std::uint32_t thread_count)
    : state_(std::make_unique<State>()) {
  state_->on_message = std::move(on_message);
  const std::string config = thread_count == 0 ? std::string() : fmt::format("threads={}", thread_count);
  state_->device = rtcNewDevice(config.c_str());
  if (state_->device == nullptr) {
    throw rhi::Error(
        rhi::ErrorCode::no_such_device, "",
        fmt::format("Embree does not start on this machine (error {})", static_cast<int>(rtcGetDeviceError(nullptr))));
  }
  rtcSetDeviceErrorFunction(state_->device, &State::report, state_.get());
  rtcSetDeviceMemoryMonitorFunction(state_->device, &State::count_memory, state_.get());
  if (rtcGetDeviceProperty(state_->device, RTC_DEVICE_PROPERTY_FILTER_FUNCTION_SUPPORTED) == 0) {
    throw rhi::Error(rhi::ErrorCode::no_such_device, "",
                     fmt::format("{} was built without filter functions, which ray queries need", embree_version()));
  }
  state_->has_ray_masks = rtcGetDeviceProperty(state_->device, RTC_DEVICE_PROPERTY_RAY_MASK_SUPPORTED) != 0;
}

EmbreeDevice::~EmbreeDevice() = default;
EmbreeDevice::EmbreeDevice(EmbreeDevice&&) noexcept = default;
EmbreeDevice& EmbreeDevice::operator=(EmbreeDevice&&) noexcept = default;

RTCDeviceTy* EmbreeDevice::get() const noexcept { return state_->device; }

bool EmbreeDevice::has_ray_masks() const noexcept { return state_->has_ray_masks; }

std::int64_t EmbreeDevice::allocated_bytes() const noexcept { return state_->allocated; }

void EmbreeDevice::check(std::string_view label) const {
  const RTCError error = rtcGetDeviceError(state_->device);
  if (error == RTC_ERROR_NONE) return;
  std::string text;
  {
    const std::lock_guard lock(state_->mutex);
    text = state_->last_text;
  }
  const rhi::ErrorCode code = error == RTC_ERROR_OUT_OF_MEMORY      ? rhi::ErrorCode::out_of_memory
                              : error == RTC_ERROR_INVALID_ARGUMENT ? rhi::ErrorCode::invalid_argument
                                                                    : rhi::ErrorCode::device_lost;
  throw rhi::Error(code, label, fmt::format("Embree reports: {}", text.empty() ? "unknown error" : text));
}

std::string embree_version() {
  return fmt::format("Embree {}.{}.{}", RTC_VERSION_MAJOR, RTC_VERSION_MINOR, RTC_VERSION_PATCH);
}

}  // namespace tandem::cpu
