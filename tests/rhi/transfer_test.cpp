#include "rhi/transfer.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "tests/support/device_test.hpp"

using namespace tandem;

TANDEM_DEVICE_TEST("vectors, arrays and spans fill a buffer, at once or with a list, and are read from any offset") {
  const std::array<std::uint32_t, 4> array = {1, 2, 3, 4};
  const std::vector<std::uint32_t> vector(array.begin(), array.end());
  const std::span<const std::uint32_t> span = vector;
  const auto usage = rhi::BufferUsage::storage;
  const rhi::CommandListHandle list = device.create_command_list("filling");
  const std::vector<rhi::BufferHandle> buffers = {rhi::create_filled(device, array, usage, "array"),
                                                  rhi::create_filled(device, vector, usage, "vector"),
                                                  rhi::create_filled(device, span, usage, "span"),
                                                  rhi::create_filled(device, *list, array, usage, "array"),
                                                  rhi::create_filled(device, *list, vector, usage, "list"),
                                                  rhi::create_filled(device, *list, span, usage, "span")};
  device.submit(list)->wait();
  for (const rhi::BufferHandle& buffer : buffers) {
    CHECK(rhi::read<std::uint32_t>(device, buffer, 4) == vector);
    CHECK(rhi::read<std::uint32_t>(device, buffer, 2, 4) == std::vector<std::uint32_t>{2, 3});
  }
}
