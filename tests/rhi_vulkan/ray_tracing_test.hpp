#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "rhi/glsl/compile.hpp"
#include "tests/rhi/dispatch.hpp"
#include "tests/rhi/ray_probe.hpp"

namespace tandem::test {

/// Shaders of a stage, compiled with the ray tracing extension; `body` declares what it needs.
inline rhi::ShaderModuleHandle ray_shader(rhi::Device& device, rhi::ShaderStage stage, const std::string& body,
                                          const std::string& label) {
  const std::string source = "#version 460\n#extension GL_EXT_ray_tracing : require\n" + body;
  const std::vector<std::uint32_t> spirv = glsl::compile(source, stage, label);
  return device.create_shader_module({.spirv = spirv, .label = label});
}

/// Bytes of a shader record.
inline std::vector<std::byte> bytes_of(std::uint32_t value) {
  const std::span<const std::byte> bytes = std::as_bytes(std::span(&value, 1));
  return {bytes.begin(), bytes.end()};
}

/// One ray for each invocation, along -z at x = 2 * invocation + 1/4, y = 1/4: what it brings back goes to results.
inline const std::string grid_of_rays = R"(
layout(set = 0, binding = 0) uniform accelerationStructureEXT scene;
layout(set = 0, binding = 1) buffer Results { uint results[]; };
layout(location = 0) rayPayloadEXT uint payload;
layout(constant_id = 0) const uint flags = 0;
void main() {
  payload = 0u;
  vec3 origin = vec3(2.0 * gl_LaunchIDEXT.x + 0.25, 0.25, 5.0);
  traceRayEXT(scene, flags, 0xff, 0, 0, 0, origin, 0.0, vec3(0, 0, -1), 100.0, 0);
  results[gl_LaunchIDEXT.x] = payload;
})";

/// Writes `expression` into the payload; `value` is the data of its record.
inline std::string answer(const std::string& expression) {
  return R"(layout(location = 0) rayPayloadInEXT uint payload;
layout(shaderRecordEXT, std430) buffer Record { uint value; };
void main() { payload = )" +
         expression + "; }";
}

}  // namespace tandem::test
