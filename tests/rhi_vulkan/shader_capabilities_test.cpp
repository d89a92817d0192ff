#include "rhi_vulkan/shader_capabilities.hpp"

#include <doctest/doctest.h>

#include <vector>

#include "rhi/glsl/compile.hpp"
#include "tests/rhi/dispatch.hpp"

using namespace tandem;

namespace {

std::vector<std::uint32_t> compile(const std::string& extension, const std::string& body) {
  return glsl::compile("#version 460\n" + extension +
                           "\nlayout(local_size_x = 1) in;\n"
                           "layout(set = 0, binding = 0) buffer Values { uint values[]; };\n" +
                           body,
                       rhi::ShaderStage::compute, "shader");
}

/// A device with no features, as data-centre GPUs have none for ray queries.
vulkan::PhysicalDevice bare_device() {
  vulkan::PhysicalDevice device;
  device.info.name = "vulkan:7";
  device.newest_spirv = 0x00010500;
  return device;
}

}  // namespace

TEST_CASE("a shader that needs nothing special passes on a device without features") {
  vulkan::check_shader_capabilities(compile("", "void main() { values[0] = 1; }"), bare_device(), "plain");
}

TEST_CASE("a ray query on a device without them is an error that names the capability and the device") {
  const std::vector<std::uint32_t> spirv =
      compile("#extension GL_EXT_ray_query : require",
              "layout(set = 0, binding = 1) uniform accelerationStructureEXT scene;\n"
              "void main() { rayQueryEXT q; rayQueryInitializeEXT(q, scene, 0, 255, vec3(0), 0, vec3(1), 1);\n"
              "rayQueryProceedEXT(q); values[0] = rayQueryGetIntersectionTypeEXT(q, true); }");
  vulkan::PhysicalDevice device = bare_device();
  CHECK_ERROR(unsupported, "RayQueryKHR, which device 'vulkan:7'",
              vulkan::check_shader_capabilities(spirv, device, "rays"));
  device.features.ray_query.rayQuery = VK_TRUE;
  vulkan::check_shader_capabilities(spirv, device, "rays");
}

TEST_CASE("64-bit types need their features") {
  const std::vector<std::uint32_t> spirv = compile("", "void main() { values[0] = uint(double(values[1]) * 1.5lf); }");
  vulkan::PhysicalDevice device = bare_device();
  CHECK_ERROR(unsupported, "doubles: the shader needs the SPIR-V capability Float64",
              vulkan::check_shader_capabilities(spirv, device, "doubles"));
  device.features.core.shaderFloat64 = VK_TRUE;
  vulkan::check_shader_capabilities(spirv, device, "doubles");
}

TEST_CASE("SPIR-V newer than the device takes is refused") {
  std::vector<std::uint32_t> spirv = compile("", "void main() { values[0] = 1; }");
  spirv[1] = 0x00010600;
  CHECK_ERROR(unsupported, "newer: the shader needs SPIR-V 1.6 (it takes at most 1.5), which device",
              vulkan::check_shader_capabilities(spirv, bare_device(), "newer"));
}

TEST_CASE("everything that is missing is told, not just the first") {
  std::vector<std::uint32_t> spirv = compile("#extension GL_EXT_shader_explicit_arithmetic_types : require",
                                             "void main() { values[0] = uint(double(float16_t(values[1])) * 1.5lf); }");
  spirv[1] = 0x00010600;
  const std::vector<std::string> missing = vulkan::missing_capabilities(spirv, bare_device());
  REQUIRE(missing.size() == 3);
  CHECK(missing[0].find("SPIR-V 1.6") == 0);
  CHECK(missing[1] == "the SPIR-V capability Float16");
  CHECK(missing[2] == "the SPIR-V capability Float64");
}

TEST_CASE("a capability that nobody knows is refused by number") {
  std::vector<std::uint32_t> spirv = compile("", "void main() { values[0] = 1; }");
  spirv[6] = 60000;  // the operand of the first OpCapability
  CHECK_ERROR(unsupported, "60000", vulkan::check_shader_capabilities(spirv, bare_device(), "odd"));
}

TEST_CASE("workgroup memory that is initialized needs its feature, of Vulkan 1.3 or of the extension") {
  const std::vector<std::uint32_t> spirv =
      compile("#extension GL_EXT_null_initializer : require",
              "shared uint zeros[4] = {}; shared uint others[4]; void main() { others[0] = zeros[0]; }");
  vulkan::PhysicalDevice device = bare_device();
  CHECK_ERROR(unsupported, "zeros: the shader needs workgroup memory that is initialized, which device",
              vulkan::check_shader_capabilities(spirv, device, "zeros"));
  device.features.vulkan13.shaderZeroInitializeWorkgroupMemory = VK_TRUE;
  vulkan::check_shader_capabilities(spirv, device, "zeros");
  device.features.vulkan13.shaderZeroInitializeWorkgroupMemory = VK_FALSE;
  device.features.zero_initialize_workgroup_memory.shaderZeroInitializeWorkgroupMemory = VK_TRUE;
  vulkan::check_shader_capabilities(spirv, device, "zeros");
  CHECK(vulkan::missing_capabilities(compile("", "shared uint s; void main() { s = 1; }"), bare_device()).empty());
}

TEST_CASE("subgroup-uniform control flow needs its feature") {
  const std::vector<std::uint32_t> spirv = compile("#extension GL_EXT_subgroup_uniform_control_flow : require",
                                                   "void main() [[subgroup_uniform_control_flow]] { values[0] = 1; }");
  vulkan::PhysicalDevice device = bare_device();
  CHECK_ERROR(unsupported, "the SPIR-V extension SPV_KHR_subgroup_uniform_control_flow",
              vulkan::check_shader_capabilities(spirv, device, "uniform"));
  device.features.subgroup_uniform_control_flow.shaderSubgroupUniformControlFlow = VK_TRUE;
  vulkan::check_shader_capabilities(spirv, device, "uniform");
}

TEST_CASE("64-bit atomics need buffers or shared memory that have them") {
  const std::vector<std::uint32_t> spirv = compile(
      "#extension GL_EXT_shader_explicit_arithmetic_types : require\n#extension GL_EXT_shader_atomic_int64 : require",
      "shared uint64_t s; void main() { atomicAdd(s, 1ul); }");
  vulkan::PhysicalDevice device = bare_device();
  device.features.core.shaderInt64 = VK_TRUE;
  CHECK_ERROR(unsupported, "the SPIR-V capability Int64Atomics",
              vulkan::check_shader_capabilities(spirv, device, "atomics"));
  device.features.vulkan12.shaderSharedInt64Atomics = VK_TRUE;
  vulkan::check_shader_capabilities(spirv, device, "atomics");
}
