#include <numeric>

#include "conformance/kit/cases.hpp"
#include "conformance/kit/check.hpp"
#include "conformance/kit/shader_run.hpp"
#include "rhi/transfer.hpp"

/// compute.dispatch: how a dispatch is launched. compute.command_list: lists that are submitted again.
namespace tandem::conformance {
namespace {

/// Counts at the place of each workgroup of a grid of 8 x 4 x 2, and keeps gl_NumWorkGroups.
const std::string count_groups = R"(#version 460
layout(local_size_x = 2) in;
layout(binding = 0) buffer Counts { uint counts[64]; uint groups[3]; uint wrong; };
void main() {
  uvec3 id = gl_WorkGroupID;
  atomicAdd(counts[(id.z * 4 + id.y) * 8 + id.x], 1);
  if (gl_GlobalInvocationID != id * gl_WorkGroupSize + gl_LocalInvocationID) atomicAdd(wrong, 1);
  groups[0] = gl_NumWorkGroups.x;
  groups[1] = gl_NumWorkGroups.y;
  groups[2] = gl_NumWorkGroups.z;
}
)";

using Size = std::array<std::uint32_t, 3>;

struct Launch {
  Size base = {0, 0, 0};
  Size count = {1, 1, 1};
  rhi::BufferRange indirect = {};
};

/// The buffer behind count_groups after `submissions` of a list with this launch.
Words counts_after(Context& context, const Launch& launch, int submissions = 1) {
  rhi::Device& device = context.device();
  const rhi::ComputePipelineHandle pipeline = context.compute_pipeline(count_groups, "count groups");
  const rhi::BufferHandle counts = words_buffer(device, Words(68), "counts");
  const rhi::BindGroupHandle group = device.create_bind_group(
      {.pipeline = pipeline, .entries = {{.binding = 0, .resource = rhi::BufferRange{counts}}}, .label = "counts"});
  const rhi::CommandListHandle list = device.create_command_list("counts");
  list->dispatch({.pipeline = pipeline,
                  .bind_groups = {group},
                  .workgroup_count = launch.count,
                  .base_workgroup = launch.base,
                  .indirect_count = launch.indirect});
  for (int i = 0; i < submissions; ++i) device.submit(list);
  return rhi::read<std::uint32_t>(device, counts, 68);
}

Words expected_counts(const Size& base, const Size& count, std::uint32_t times) {
  Words words(68);
  for (std::uint32_t z = base[2]; z < base[2] + count[2]; ++z)
    for (std::uint32_t y = base[1]; y < base[1] + count[1]; ++y)
      for (std::uint32_t x = base[0]; x < base[0] + count[0]; ++x) words[(z * 4 + y) * 8 + x] = 2 * times;
  for (std::size_t i = 0; i < 3; ++i) words[64 + i] = count[i];
  return words;
}

void add_dispatch_cases(const Group& group) {
  group.add("base_group", "workgroups are counted from the base", [](Context& context) {
    const Launch launch = {.base = {3, 1, 1}, .count = {5, 2, 1}};
    check_words(counts_after(context, launch), expected_counts(launch.base, launch.count, 1));
  });
  group.add("indirect", "a dispatch takes its size from a buffer", [](Context& context) {
    const rhi::BufferHandle size =
        rhi::create_filled(context.device(), Words{99, 7, 3, 2, 99}, rhi::BufferUsage::indirect, "size");
    check_words(counts_after(context, {.indirect = {size, 4}}), expected_counts({0, 0, 0}, {7, 3, 2}, 1));
  });
  group.add("indirect_zero", "an indirect dispatch of no workgroups runs none", [](Context& context) {
    const rhi::BufferHandle size =
        rhi::create_filled(context.device(), Words{4, 0, 2}, rhi::BufferUsage::indirect, "size");
    check_words(counts_after(context, {.indirect = {size}}), Words(68));
  });
}

void add_command_list_cases(const Group& group) {
  group.add("submitted_again", "a list runs each time that it is submitted", [](Context& context) {
    check_words(counts_after(context, {.count = {8, 4, 2}}, 3), expected_counts({0, 0, 0}, {8, 4, 2}, 3));
  });
  group.add("uploads_again", "an upload writes its bytes at every submission", [](Context& context) {
    rhi::Device& device = context.device();
    const rhi::BufferHandle words = words_buffer(device, {1, 2}, "words");
    const Words sevens = {7, 7};
    const rhi::CommandListHandle upload = device.create_command_list("upload");
    upload->upload(words, 0, std::as_bytes(std::span(sevens)));
    const rhi::CommandListHandle clear = device.create_command_list("clear");
    clear->fill({words}, 0);
    device.submit(upload);
    device.submit(clear);
    check_words(rhi::read<std::uint32_t>(device, words, 2), Words{0, 0});
    device.submit(upload);
    check_words(rhi::read<std::uint32_t>(device, words, 2), sevens);
  });
  group.add("closed", "nothing can be recorded once a list was submitted", [](Context& context) {
    rhi::Device& device = context.device();
    const rhi::BufferHandle words = words_buffer(device, {1}, "words");
    const rhi::CommandListHandle list = device.create_command_list("closed");
    list->fill({words}, 0);
    device.submit(list);
    bool refused = false;
    try {
      list->fill({words}, 1);
    } catch (const rhi::Error& error) {
      refused = error.code() == rhi::ErrorCode::invalid_argument;
    }
    check(refused, "a command was recorded after the list was submitted");
  });
}

}  // namespace

void add_compute_cases(Cases& cases) {
  add_dispatch_cases({cases, "compute.dispatch", {}});
  add_command_list_cases({cases, "compute.command_list", {}});
}

}  // namespace tandem::conformance
