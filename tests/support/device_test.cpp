#include "tests/support/device_test.hpp"

#include <cstdlib>
#include <deque>
#include <filesystem>
#include <map>
#include <memory>
#include <sstream>
#include <stdexcept>

#include "devices/devices.hpp"
#include "rhi/glsl/compile.hpp"
#include "tests/support/messages.hpp"
#include "tests/support/run_summary.hpp"

namespace tandem::test {
namespace {

/// A device and what has been said of it. The messages outlive the device, which may speak while it is destroyed.
struct DeviceUnderTest {
  std::shared_ptr<Messages> messages = std::make_shared<Messages>();
  rhi::DeviceHandle device;

  std::vector<std::string> take_warnings() {
    std::vector<std::string> warnings;
    for (const rhi::Message& message : messages->take())
      if (message.severity != rhi::Severity::info) warnings.push_back(message.source + ": " + message.text);
    return warnings;
  }
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
    desc.on_message = [messages = entry.messages](const rhi::Message& message) { messages->add(message); };
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

std::vector<std::string> take_warnings(const std::string& name) { return device_under_test(name).take_warnings(); }

NoWarnings::~NoWarnings() {
  for (const std::string& name : names_) {
    const auto found = devices_under_test().find(name);
    if (found == devices_under_test().end()) continue;  // the test never came to use it
    for (const std::string& warning : found->second.take_warnings()) FAIL_CHECK(warning);
  }
}

void run_device_test(DeviceTest test, std::size_t device_index) {
  const std::string& name = device_names().at(device_index);
  const rhi::DeviceHandle handle = device(name);
  const NoWarnings no_warnings({name});
  test(name, handle, *handle);
}

std::size_t register_device_test(const char* name, const DeviceTestRuns& runs, const char* file, unsigned line,
                                 const doctest::detail::TestSuite& suite) {
  // doctest keeps pointers to the names, and a deque leaves its elements where they are.
  static std::deque<std::string> case_names;
  const std::size_t count = device_names().size();
  if (count > runs.size()) throw std::invalid_argument("TANDEM_TEST_DEVICES names too many devices");
  for (std::size_t i = 0; i < count; ++i) {
    const std::string& case_name = case_names.emplace_back(std::string(name) + " [" + device_names()[i] + "]");
    doctest::detail::regTest(doctest::detail::TestCase(runs[i], file, line, suite) * case_name.c_str());
    RunSummary::of_this_run().add_device_case(case_name.c_str(), i);
  }
  return count;
}

std::vector<std::string> release_devices() {
  std::vector<std::string> warnings;
  for (auto& [name, entry] : devices_under_test()) {
    entry.device = nullptr;
    const std::vector<std::string> last = entry.take_warnings();
    warnings.insert(warnings.end(), last.begin(), last.end());
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
