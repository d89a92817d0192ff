// Runs a ray-tracing shader of your own, GLSL from a file, on a device, and prints what it wrote.
// Usage: your_shader SHADER.comp [DEVICE]

#include <array>
#include <cstdio>
#include <devices/devices.hpp>
#include <exception>
#include <fstream>
#include <iterator>
#include <rhi/build.hpp>
#include <rhi/glsl/compile.hpp>
#include <rhi/transfer.hpp>
#include <string>

using namespace tandem;
using rhi::BufferUsage;

int main(int argc, char** argv) try {
  std::ifstream file(argc > 1 ? argv[1] : "shadow.comp");
  const std::string source{std::istreambuf_iterator<char>(file), {}};
  const rhi::DeviceHandle device = create_device({.name = argc > 2 ? argv[2] : "cpu"});

  // The geometry: one triangle, 1 above the plane, and an instance of it.
  const std::array<float, 9> corners = {0, 1, 0, 1, 1, 0, 0, 1, 1};
  const auto vertices = rhi::create_filled(*device, corners, BufferUsage::acceleration_structure_input, "corners");
  const rhi::TriangleGeometry triangle{.vertices = {vertices}, .vertex_count = 3, .triangle_count = 1};
  const auto blas = rhi::build_bottom_level(*device, {.geometries = {triangle}, .label = "triangle"});
  const std::array instances = {rhi::make_instance(*blas)};
  const auto instance_buffer =
      rhi::create_filled(*device, instances, BufferUsage::acceleration_structure_input, "instances");
  const auto tlas = rhi::build_top_level(*device, {.instances = {instance_buffer}, .instance_count = 1});

  // The shader: the same SPIR-V on every device.
  const auto module =
      device->create_shader_module({.spirv = glsl::compile(source, rhi::ShaderStage::compute, "shadow")});
  const auto pipeline = device->create_compute_pipeline({.shader = module, .label = "shadow"});
  const auto shadow = device->create_buffer({.size = 16 * 4, .usage = BufferUsage::storage, .label = "shadow"});
  const auto group = device->create_bind_group(
      {.pipeline = pipeline,
       .entries = {{.binding = 0, .resource = tlas}, {.binding = 1, .resource = rhi::BufferRange{shadow}}}});
  const auto list = device->create_command_list("shadow");
  list->dispatch({.pipeline = pipeline, .bind_groups = {group}});
  device->submit(list)->wait();

  for (const unsigned value : rhi::read<unsigned>(*device, shadow, 16)) std::printf("%u", value);
  std::printf("\n");
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "your_shader: %s\n", error.what());
  return 2;
}
