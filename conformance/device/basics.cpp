#include <algorithm>
#include <array>
#include <functional>
#include <numeric>
#include <span>

#include "conformance/kit/cases.hpp"
#include "conformance/kit/check.hpp"
#include "conformance/kit/scene.hpp"
#include "conformance/kit/shader_run.hpp"

/// device.buffers and device.compute: what every other case stands on. They need no capability.
namespace tandem::conformance {
namespace {

Words counted(std::uint32_t count, std::uint32_t first = 0) {
  Words words(count);
  std::iota(words.begin(), words.end(), first);
  return words;
}

void submit(rhi::Device& device, const std::function<void(rhi::CommandList&)>& record) {
  const rhi::CommandListHandle list = device.create_command_list("commands");
  record(*list);
  device.submit(list)->wait();
}

void add_buffer_cases(const Group& group) {
  group.add("upload_and_download", "a buffer holds what was uploaded", [](Context& context) {
    const rhi::BufferHandle buffer = buffer_of(context.device(), counted(1000), "words");
    check_words(rhi::read<std::uint32_t>(context.device(), buffer, 1000), counted(1000));
  });
  group.add("upload_offset", "an upload at an offset leaves the rest as it was", [](Context& context) {
    rhi::Device& device = context.device();
    const rhi::BufferHandle buffer = buffer_of(device, counted(8), "words");
    const Words two = {100, 101};
    submit(device, [&](rhi::CommandList& list) { list.upload(buffer, 12, std::as_bytes(std::span(two))); });
    check_words(rhi::read<std::uint32_t>(device, buffer, 8), {0, 1, 2, 100, 101, 5, 6, 7});
  });
  group.add("download_offset", "a download may begin inside a buffer", [](Context& context) {
    const rhi::BufferHandle buffer = buffer_of(context.device(), counted(8), "words");
    check_words(rhi::read<std::uint32_t>(context.device(), buffer, 3, 16), {4, 5, 6});
  });
  group.add("copy", "a copy moves a range to another offset of another buffer", [](Context& context) {
    rhi::Device& device = context.device();
    const rhi::BufferHandle source = buffer_of(device, counted(8), "source");
    const rhi::BufferHandle destination = buffer_of(device, Words(8, 9), "destination");
    submit(device, [&](rhi::CommandList& list) { list.copy({source, 8, 12}, {destination, 16, 12}); });
    check_words(rhi::read<std::uint32_t>(device, destination, 8), {9, 9, 9, 9, 2, 3, 4, 9});
  });
  group.add("fill", "a fill writes its word over the range and no further", [](Context& context) {
    rhi::Device& device = context.device();
    const rhi::BufferHandle buffer = buffer_of(device, Words(6, 1), "words");
    submit(device, [&](rhi::CommandList& list) { list.fill({buffer, 4, 12}, 0xdeadbeef); });
    check_words(rhi::read<std::uint32_t>(device, buffer, 6), {1, 0xdeadbeef, 0xdeadbeef, 0xdeadbeef, 1, 1});
  });
  group.add("order", "a command sees what the one before it wrote", [](Context& context) {
    rhi::Device& device = context.device();
    const rhi::BufferHandle first = buffer_of(device, Words(4), "first");
    const rhi::BufferHandle second = buffer_of(device, Words(4), "second");
    const Words words = {1, 2, 3, 4};
    submit(device, [&](rhi::CommandList& list) {
      list.upload(first, 0, std::as_bytes(std::span(words)));
      list.copy({first}, {second});
      list.fill({first}, 7);
      list.copy({first, 0, 4}, {second, 0, 4});
    });
    check_words(rhi::read<std::uint32_t>(device, second, 4), {7, 2, 3, 4});
  });
  group.add("upload_copies", "an upload keeps the bytes that it was given when it was recorded", [](Context& context) {
    rhi::Device& device = context.device();
    const rhi::BufferHandle buffer = buffer_of(device, Words(2), "words");
    Words words = {1, 2};
    submit(device, [&](rhi::CommandList& list) {
      list.upload(buffer, 0, std::as_bytes(std::span(words)));
      words = {3, 4};
    });
    check_words(rhi::read<std::uint32_t>(device, buffer, 2), {1, 2});
  });
}

const std::string compute_source = R"(#version 460
layout(local_size_x = 16) in;
layout(set = 0, binding = 0, std430) readonly buffer Source { uint source[]; };
layout(set = 0, binding = 1, std430) writeonly buffer Destination { uint destination[]; };
layout(push_constant) uniform Constants { uint factor; uint summand; };
void main() {
  uint i = gl_GlobalInvocationID.x;
  destination[i] = source[i] * factor + summand;
}
)";

void add_compute_cases(const Group& group) {
  // destination = source * factor + summand, 64 words
  static constexpr auto dispatch = [](Context& context, rhi::CommandList& list, const rhi::BufferRange& source,
                                      const rhi::BufferRange& destination, std::array<std::uint32_t, 2> constants) {
    const rhi::ComputePipelineHandle pipeline = context.compute_pipeline(compute_source, "multiply and add");
    const rhi::BindGroupHandle bindings = context.device().create_bind_group(
        {.pipeline = pipeline,
         .entries = {{.binding = 0, .resource = source}, {.binding = 1, .resource = destination}},
         .label = "buffers"});
    list.dispatch({.pipeline = pipeline,
                   .bind_groups = {bindings},
                   .push_constants = std::as_bytes(std::span(constants)),
                   .workgroup_count = {4, 1, 1}});
  };
  const auto expected = [](std::uint32_t factor, std::uint32_t summand) {
    Words words = counted(64);
    for (std::uint32_t& word : words) word = word * factor + summand;
    return words;
  };
  group.add("dispatch", "every invocation of a dispatch runs once, with its push constants", [=](Context& context) {
    rhi::Device& device = context.device();
    const rhi::BufferHandle source = buffer_of(device, counted(64), "source");
    const rhi::BufferHandle destination = buffer_of(device, Words(64), "destination");
    submit(device, [&](rhi::CommandList& list) { dispatch(context, list, {source}, {destination}, {3, 5}); });
    check_words(rhi::read<std::uint32_t>(device, destination, 64), expected(3, 5));
  });
  group.add("dispatch_order", "a dispatch sees what the one before it wrote", [=](Context& context) {
    rhi::Device& device = context.device();
    const rhi::BufferHandle first = buffer_of(device, counted(64), "first");
    const rhi::BufferHandle second = buffer_of(device, Words(64), "second");
    submit(device, [&](rhi::CommandList& list) {
      dispatch(context, list, {first}, {second}, {2, 1});
      dispatch(context, list, {second}, {first}, {10, 3});
    });
    check_words(rhi::read<std::uint32_t>(device, first, 64), expected(20, 13));
  });
  group.add("bound_range", "a bound range begins at its offset", [=](Context& context) {
    rhi::Device& device = context.device();
    const std::uint64_t offset = std::max<std::uint64_t>(256, device.info().limits.storage_buffer_offset_alignment);
    Words words(offset / 4, 99);
    const Words rest = counted(64);
    words.insert(words.end(), rest.begin(), rest.end());
    const rhi::BufferHandle source = buffer_of(device, words, "source");
    const rhi::BufferHandle destination = buffer_of(device, Words(64), "destination");
    submit(device, [&](rhi::CommandList& list) { dispatch(context, list, {source, offset}, {destination}, {1, 0}); });
    check_words(rhi::read<std::uint32_t>(device, destination, 64), expected(1, 0));
  });
}

}  // namespace

void add_device_cases(Cases& cases) {
  add_buffer_cases({cases, "device.buffers", {}});
  add_compute_cases({cases, "device.compute", {}});
}

}  // namespace tandem::conformance
