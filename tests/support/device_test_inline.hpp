#pragma once

#include <array>

namespace tandem::test {

/// The body of a TANDEM_DEVICE_TEST.
using DeviceTest = void (*)(const std::string& device_name, const rhi::DeviceHandle& device_handle,
                            rhi::Device& device);

/// $TANDEM_TEST_DEVICES may name so many devices: doctest calls a plain function, so there has to be one for each.
inline constexpr std::size_t most_devices = 8;

/// Runs the body on device_names()[device_index].
void run_device_test(DeviceTest test, std::size_t device_index);

template <DeviceTest test, std::size_t device_index>
void run_device_test() {
  run_device_test(test, device_index);
}

using DeviceTestRuns = std::array<doctest::detail::funcType, most_devices>;

template <DeviceTest test, std::size_t... indices>
constexpr DeviceTestRuns device_test_runs(std::index_sequence<indices...>) {
  return {&run_device_test<test, indices>...};
}

/// Registers a case per device; returns how many.
/// @param runs the body on the first device, on the second, ...
std::size_t register_device_test(const char* name, const DeviceTestRuns& runs, const char* file, unsigned line,
                                 const doctest::detail::TestSuite& suite);

template <typename T>
rhi::BufferHandle buffer_of(rhi::Device& device, const std::vector<T>& values, const std::string& label) {
  using rhi::BufferUsage;
  const std::span<const std::byte> bytes = std::as_bytes(std::span(values));
  rhi::BufferHandle buffer =
      device.create_buffer({.size = bytes.size(),
                            .usage = BufferUsage::storage | BufferUsage::uniform |
                                     BufferUsage::acceleration_structure_input | BufferUsage::device_address,
                            .label = label});
  rhi::CommandListHandle list = device.create_command_list("upload " + label);
  list->upload(buffer, 0, bytes);
  device.submit(list)->wait();
  return buffer;
}

template <typename T>
std::vector<T> contents(rhi::Device& device, const rhi::BufferHandle& buffer, std::size_t count) {
  std::vector<T> values(count);
  device.download(buffer, 0, std::as_writable_bytes(std::span(values)));
  return values;
}

}  // namespace tandem::test

#define TANDEM_DEVICE_TEST_IMPLEMENTATION(name, function)                                                          \
  static void function(const std::string& device_name, const ::tandem::rhi::DeviceHandle& device_handle,           \
                       ::tandem::rhi::Device& device);                                                             \
  [[maybe_unused]] static const std::size_t DOCTEST_CAT(function, _count) = ::tandem::test::register_device_test(  \
      name, ::tandem::test::device_test_runs<&function>(std::make_index_sequence<::tandem::test::most_devices>()), \
      __FILE__, __LINE__, doctest_detail_test_suite_ns::getCurrentTestSuite());                                    \
  static void function([[maybe_unused]] const std::string& device_name,                                            \
                       [[maybe_unused]] const ::tandem::rhi::DeviceHandle& device_handle,                          \
                       [[maybe_unused]] ::tandem::rhi::Device& device)
