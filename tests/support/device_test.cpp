#include "tests/support/device_test.hpp"

#include <cstdlib>
#include <map>
#include <mutex>
#include <sstream>
#include <utility>

#include "devices/devices.hpp"
#include "rhi/glsl/compile.hpp"

namespace tandem::test {
namespace {

/// A device and what has been said of it. The messages outlive the device, which may speak while it is destroyed.
struct DeviceUnderTest {
  struct Warnings {
    std::mutex mutex;
    std::vector<std::string> texts;
  };
  std::shared_ptr<Warnings> warnings = std::make_shared<Warnings>();
  rhi::DeviceHandle device;
};

std::map<std::string, DeviceUnderTest>& devices_under_test() {
  static std::map<std::string, DeviceUnderTest> devices;
  return devices;
}

DeviceUnderTest& device_under_test(const std::string& name) {
  DeviceUnderTest& entry = devices_under_test()[name];
  if (entry.device == nullptr) {
    rhi::DeviceDesc desc;
    desc.name = name;
    desc.driver_validation = true;
    desc.on_message = [warnings = entry.warnings](const rhi::Message& message) {
      if (message.severity == rhi::Severity::info) return;
      const std::lock_guard lock(warnings->mutex);
      warnings->texts.push_back(message.source + ": " + message.text);
    };
    entry.device = create_device(desc);
  }
  return entry;
}

}  // namespace

const std::vector<std::string>& device_names() {
  static const std::vector<std::string> names = [] {
    const char* chosen = std::getenv("TANDEM_TEST_DEVICES");
    std::istringstream list(chosen != nullptr ? chosen : "cpu,vulkan");
    std::vector<std::string> result;
    for (std::string name; std::getline(list, name, ',');) result.push_back(name);
    return result;
  }();
  return names;
}

rhi::DeviceHandle device(const std::string& name) { return device_under_test(name).device; }

std::vector<std::string> take_warnings(const std::string& name) {
  DeviceUnderTest::Warnings& warnings = *device_under_test(name).warnings;
  const std::lock_guard lock(warnings.mutex);
  return std::exchange(warnings.texts, {});
}

std::vector<std::string> release_devices() {
  std::vector<std::string> warnings;
  for (auto& [name, entry] : devices_under_test()) {
    entry.device = nullptr;
    const std::lock_guard lock(entry.warnings->mutex);
    warnings.insert(warnings.end(), entry.warnings->texts.begin(), entry.warnings->texts.end());
  }
  devices_under_test().clear();
  return warnings;
}

rhi::ComputePipelineHandle compute_pipeline(rhi::Device& device, const std::string& glsl, const std::string& label,
                                            std::vector<rhi::SpecializationValue> specialization) {
  glsl::CompileOptions options;
  options.include_directories = {std::filesystem::path(TANDEM_SOURCE_DIRECTORY) / "shaders"};
  const std::vector<std::uint32_t> spirv = glsl::compile(glsl, rhi::ShaderStage::compute, label, options);
  const rhi::ShaderModuleHandle shader = device.create_shader_module({.spirv = spirv, .label = label});
  return device.create_compute_pipeline(
      {.shader = shader, .specialization = std::move(specialization), .label = label});
}

}  // namespace tandem::test
