#include <doctest/doctest.h>

#include <algorithm>
#include <cstring>
#include <numeric>

#include "tests/rhi/dispatch.hpp"

using namespace tandem;
using test::contents;

namespace {

std::vector<std::uint32_t> counting(std::size_t count, std::uint32_t first = 0) {
  std::vector<std::uint32_t> values(count);
  std::iota(values.begin(), values.end(), first);
  return values;
}

rhi::BufferHandle buffer_of_size(rhi::Device& device, std::uint64_t size, const std::string& label = "buffer") {
  return device.create_buffer({.size = size, .label = label});
}

}  // namespace

TANDEM_DEVICE_TEST("what is uploaded comes back") {
  const std::vector<std::uint32_t> values = counting(1000);
  CHECK(contents<std::uint32_t>(device, test::buffer_of(device, values, "values"), values.size()) == values);
}

TANDEM_DEVICE_TEST("uploads and downloads take any offset and size") {
  const rhi::BufferHandle buffer = buffer_of_size(device, 13);
  const std::vector<std::uint8_t> zeros(13, 0);
  const std::vector<std::uint8_t> part = {1, 2, 3, 4, 5};
  const rhi::CommandListHandle list = device.create_command_list("odd uploads");
  list->upload(buffer, 0, std::as_bytes(std::span(zeros)));
  list->upload(buffer, 3, std::as_bytes(std::span(part)));
  list->upload(buffer, 7, {});
  device.submit(list);
  std::vector<std::uint8_t> read(6);
  device.download(buffer, 2, std::as_writable_bytes(std::span(read)));
  CHECK(read == std::vector<std::uint8_t>{0, 1, 2, 3, 4, 5});
  device.download(buffer, 13, {});
}

TANDEM_DEVICE_TEST("transfers larger than any staging piece arrive whole") {
  // 72 MiB and a little: more than two pieces of 32 MiB in the Vulkan device, and not a multiple of them.
  const std::vector<std::uint32_t> values = counting((72u << 18) + 3, 5);
  const rhi::BufferHandle buffer = test::buffer_of(device, values, "large");
  CHECK(contents<std::uint32_t>(device, buffer, values.size()) == values);
}

TANDEM_DEVICE_TEST("upload copies the bytes when it is called") {
  std::vector<std::uint32_t> values = counting(64);
  const rhi::BufferHandle buffer = buffer_of_size(device, 256);
  const rhi::CommandListHandle list = device.create_command_list("early upload");
  list->upload(buffer, 0, std::as_bytes(std::span(values)));
  std::fill(values.begin(), values.end(), 0u);
  device.submit(list);
  CHECK(contents<std::uint32_t>(device, buffer, 64) == counting(64));
}

TANDEM_DEVICE_TEST("copies move a range and leave the rest") {
  const rhi::BufferHandle source = test::buffer_of(device, counting(16), "source");
  const rhi::BufferHandle target = test::buffer_of(device, std::vector<std::uint32_t>(16, 99), "target");
  const rhi::CommandListHandle list = device.create_command_list("copy");
  list->copy({source, 8, 16}, {target, 24, 16});
  list->copy({target, 24, 16}, {target, 48, 16});  // within one buffer
  device.submit(list);
  std::vector<std::uint32_t> expected(16, 99);
  for (std::uint32_t i = 0; i < 4; ++i) expected[6 + i] = expected[12 + i] = 2 + i;
  CHECK(contents<std::uint32_t>(device, target, 16) == expected);
}

TANDEM_DEVICE_TEST("fills write 32 bits over a range") {
  const rhi::BufferHandle buffer = test::buffer_of(device, std::vector<std::uint32_t>(8, 1), "filled");
  const rhi::CommandListHandle list = device.create_command_list("fill");
  list->fill({buffer, 8, 12}, 0xdeadbeef);
  list->fill({buffer, 28}, 7);
  device.submit(list);
  CHECK(contents<std::uint32_t>(device, buffer, 8) ==
        std::vector<std::uint32_t>{1, 1, 0xdeadbeef, 0xdeadbeef, 0xdeadbeef, 1, 1, 7});
}

TANDEM_DEVICE_TEST("each transfer sees what the one before it wrote") {
  // Large enough that a device which ran them side by side would be caught at it.
  constexpr std::size_t count = 1 << 20;
  const rhi::BufferHandle a = buffer_of_size(device, count * 4, "a");
  const rhi::BufferHandle b = buffer_of_size(device, count * 4, "b");
  const std::vector<std::uint32_t> values = counting(count);
  const rhi::CommandListHandle list = device.create_command_list("chain");
  list->fill({a}, 1);
  list->upload(a, 0, std::as_bytes(std::span(values)));
  list->copy({a}, {b});
  list->fill({a}, 2);
  list->copy({b, 0, 4096}, {a, 4096, 4096});
  device.submit(list);
  CHECK(contents<std::uint32_t>(device, b, count) == values);
  std::vector<std::uint32_t> expected(count, 2);
  std::copy_n(values.begin(), 1024, expected.begin() + 1024);
  CHECK(contents<std::uint32_t>(device, a, count) == expected);
}

TANDEM_DEVICE_TEST("submissions take effect in order") {
  const rhi::BufferHandle buffer = buffer_of_size(device, 1 << 20);
  for (std::uint32_t i = 0; i < 20; ++i) {
    const rhi::CommandListHandle list = device.create_command_list("fill " + std::to_string(i));
    list->fill({buffer}, i);
    device.submit(list);
  }
  CHECK(contents<std::uint32_t>(device, buffer, 1 << 18) == std::vector<std::uint32_t>(1 << 18, 19));
}

TANDEM_DEVICE_TEST("many buffers of many sizes do not share bytes") {
  std::vector<rhi::BufferHandle> buffers;
  const rhi::CommandListHandle list = device.create_command_list("fill all");
  for (std::uint32_t i = 0; i < 300; ++i) {
    buffers.push_back(buffer_of_size(device, 4 * (1 + (i * 7919) % 1000), "buffer " + std::to_string(i)));
    if (i % 3 == 2) buffers[i - 1] = nullptr;  // gaps, so that memory is used again
  }
  for (std::uint32_t i = 0; i < buffers.size(); ++i)
    if (buffers[i]) list->fill({buffers[i]}, i);
  device.submit(list);
  for (std::uint32_t i = 0; i < buffers.size(); i += 50) {
    if (!buffers[i]) continue;
    const std::size_t count = buffers[i]->size() / 4;
    CHECK(contents<std::uint32_t>(device, buffers[i], count) == std::vector<std::uint32_t>(count, i));
  }
}

TANDEM_DEVICE_TEST("a command list keeps its buffers until it has executed") {
  const rhi::BufferHandle kept = buffer_of_size(device, 1 << 20, "kept");
  rhi::FenceHandle fence;
  {
    const rhi::BufferHandle dropped = test::buffer_of(device, counting(1 << 18), "dropped");
    const rhi::CommandListHandle list = device.create_command_list("last user");
    list->copy({dropped}, {kept});
    fence = device.submit(list);
  }
  fence->wait();
  CHECK(contents<std::uint32_t>(device, kept, 1 << 18) == counting(1 << 18));
}

TANDEM_DEVICE_TEST("addresses differ and are only for buffers that ask") {
  const rhi::BufferDesc desc = {.size = 256, .usage = rhi::BufferUsage::device_address, .label = "addressed"};
  const rhi::BufferHandle a = device.create_buffer(desc);
  const rhi::BufferHandle b = device.create_buffer(desc);
  CHECK(a->device_address() != 0);
  const std::uint64_t distance =
      std::max(a->device_address(), b->device_address()) - std::min(a->device_address(), b->device_address());
  CHECK(distance >= 256);
  CHECK_ERROR(invalid_argument, "plain: ", buffer_of_size(device, 4, "plain")->device_address());
}

TANDEM_DEVICE_TEST("broken rules of buffers and transfers are errors that name the object") {
  CHECK_ERROR(invalid_argument, "nothing: ", device.create_buffer({.size = 0, .label = "nothing"}));
  const rhi::BufferHandle buffer = buffer_of_size(device, 16, "short");
  const rhi::CommandListHandle list = device.create_command_list("transfers");
  const std::vector<std::byte> bytes(17);
  CHECK_ERROR(invalid_argument, "'short'", list->upload(buffer, 0, bytes));
  CHECK_ERROR(invalid_argument, "'short'", list->upload(buffer, ~std::uint64_t{0}, std::span(bytes).first(1)));
  CHECK_ERROR(invalid_argument, "transfers: ", list->upload(nullptr, 0, bytes));
  CHECK_ERROR(invalid_argument, "overlaps", list->copy({buffer, 0, 8}, {buffer, 4, 8}));
  CHECK_ERROR(invalid_argument, "transfers: ", list->copy({buffer, 0, 8}, {buffer, 8, 4}));
  CHECK_ERROR(invalid_argument, "transfers: ", list->copy({}, {buffer}));
  CHECK_ERROR(invalid_argument, "multiple of 4", list->fill({buffer, 2, 4}, 0));
  CHECK_ERROR(invalid_argument, "multiple of 4", list->fill({buffer, 0, 5}, 0));
  CHECK_ERROR(invalid_argument, "'short'", list->fill({buffer, 16}, 0));
  std::vector<std::byte> read(17);
  CHECK_ERROR(invalid_argument, "'short'", device.download(buffer, 0, read));
  CHECK_ERROR(invalid_argument, "", device.download(nullptr, 0, read));
  device.submit(list)->wait();
}
