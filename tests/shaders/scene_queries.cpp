#include "tests/shaders/scene_queries.hpp"

namespace tandem::test {

void run_queries(rhi::Device& device, const DeviceScene& scene, const std::string& glsl, const std::string& label,
                 const rhi::BufferHandle& queries, const rhi::BufferHandle& answers, std::size_t count) {
  const rhi::ComputePipelineHandle pipeline = compute_pipeline(device, glsl, label);
  const auto whole = [](const rhi::BufferHandle& buffer) { return rhi::BufferRange{.buffer = buffer}; };
  const rhi::BindGroupHandle scene_group =
      device.create_bind_group({.pipeline = pipeline,
                                .set = 0,
                                .entries = scene_entries(pipeline->interface(), scene, scene.unused),
                                .label = "scene"});
  const rhi::BindGroupHandle query_group = device.create_bind_group(
      {.pipeline = pipeline,
       .set = 1,
       .entries = {{.binding = 2, .resource = whole(queries)}, {.binding = 3, .resource = whole(answers)}},
       .label = "queries"});
  const rhi::CommandListHandle list = device.create_command_list(label);
  list->dispatch({.pipeline = pipeline,
                  .bind_groups = {scene_group, query_group},
                  .workgroup_count = {static_cast<std::uint32_t>(count + 63) / 64, 1, 1}});
  device.submit(list)->wait();
}

}  // namespace tandem::test
