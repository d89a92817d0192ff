#include "tests/program/faults/explained_shader.hpp"

#include <cstdint>
#include <cstring>
#include <span>
#include <utility>

#include "rhi/glsl/compile.hpp"

namespace tandem::test {
namespace {

using program::BufferUse;
using program::Job;

constexpr std::uint32_t invocations = 64;

// Each line has one operation that a fault is put into, so that a line names it.
constexpr const char* floats = R"(#version 460
layout(local_size_x = 16) in;
layout(set = 0, binding = 0) readonly buffer In { float values[]; };
layout(set = 0, binding = 1) buffer Out { float result[]; };
float shape(float x, float y) {
  precise float root = sqrt(x * x + 1.0);
  precise float difference = root - y;
  precise float product = difference * 0.75;
  precise float quotient = product / (root + 2.0);
  float limited = clamp(quotient * 8.0, -0.5, 0.5);
  float power = exp2(limited);
  float inverse = inversesqrt(root + 0.5);
  float flipped = -inverse;
  return power < inverse ? flipped : power + smoothstep(-1.0, 3.0, y);
}
void main() {
  uint i = gl_GlobalInvocationID.x;
  float x = values[2u * i], y = values[2u * i + 1u];
  float shaped = shape(x, y);
  float nearer = min(shaped, y);
  bool equal = x == floor(x);
  result[2u * i] = equal ? 2.0 : nearer;
  result[2u * i + 1u] = mix(shaped, nearer, 0.25);
}
)";

constexpr const char* integers = R"(#version 460
layout(local_size_x = 16) in;
layout(set = 0, binding = 0) readonly buffer In { float values[]; };
layout(set = 0, binding = 1) buffer Out { uint result[]; };
uint hash(uint x) {
  x ^= x >> 2;
  x *= 0x2c1b3c6du;
  x = x | (x << 3);
  return x;
}
void main() {
  uint i = gl_GlobalInvocationID.x;
  uint bits = hash(i + 1u);
  int whole = int(values[i] * 100.0);
  int halved = whole >> 1;
  uint field = bitfieldExtract(bits, 5, 7);
  uint rest = bits % (field + 3u);
  int top = findMSB(bits);
  int reversed = int(bitfieldReverse(bits) >> 20);
  uint counted = bitCount(bits);
  uint high, low;
  umulExtended(bits, 77777u, high, low);
  result[2u * i] = uint(halved + top) + rest * counted;
  result[2u * i + 1u] = high - low + uint(reversed);
}
)";

constexpr const char* shared_memory = R"(#version 460
layout(local_size_x = 16) in;
layout(set = 0, binding = 0) readonly buffer In { float values[]; };
layout(set = 0, binding = 1) buffer Out { uint result[]; };
shared uint tile[16];
shared uint largest;
void main() {
  uint local = gl_LocalInvocationIndex;
  tile[local] = uint(values[gl_GlobalInvocationID.x] * 1000.0) & 1023u;
  if (local == 0u) largest = 0u;
  barrier();
  uint other = tile[15u - local];
  atomicMax(largest, other + local);
  barrier();
  uint found = largest;
  atomicAdd(result[126], found & 7u);
  atomicAdd(result[127], 1u);
  result[gl_GlobalInvocationID.x] = other * 2u + found;
}
)";

constexpr const char* control = R"(#version 460
layout(local_size_x = 16) in;
layout(set = 0, binding = 0) readonly buffer In { float values[]; };
layout(set = 0, binding = 1) buffer Out { float result[]; };
struct Ball { vec3 centre; float radius; };
vec3 turned(vec3 v, mat3 m) {
  vec3 straight = m * v;
  return straight.zxy;
}
void main() {
  uint i = gl_GlobalInvocationID.x;
  Ball ball = Ball(vec3(values[i], values[i + 1u], 1.0), 0.75);
  mat3 m = mat3(0.5, 0.25, -1.0, 1.0, 2.0, 0.125, -0.5, 0.75, 1.5);
  float sum = 0.0;
  for (uint k = 0u; k < (i & 3u) + 2u; ++k) {
    ball.centre = turned(ball.centre, m) * 0.5;
    float along = dot(ball.centre, vec3(1.0, 2.0, 3.0));
    bool far = along > ball.radius;
    if (far && k > 0u)
      sum += along;
    else
      sum -= ball.centre.y;
  }
  int chosen = (i & 1u) == 0u ? 3 : 5;
  switch (chosen) {
    case 3: sum *= 2.0; break;
    default: sum += 1.0;
  }
  vec2 pair = vec2(sum, float(chosen));
  result[2u * i] = pair.x;
  result[2u * i + 1u] = length(ball.centre) + pair.y;
}
)";

constexpr const char* rays = R"(#version 460
#extension GL_EXT_ray_query : require
layout(local_size_x = 16) in;
layout(set = 0, binding = 0) readonly buffer In { float values[]; };
layout(set = 0, binding = 1) buffer Out { float result[]; };
layout(set = 0, binding = 2) uniform accelerationStructureEXT scene;
void main() {
  uint i = gl_GlobalInvocationID.x;
  vec3 origin = vec3(0.13 + 0.11 * float(i % 8u), 0.07 + 0.12 * float(i / 8u), 3.0);
  rayQueryEXT query;
  rayQueryInitializeEXT(query, scene, gl_RayFlagsOpaqueEXT, 0xff, origin, 0.0, vec3(0.0, 0.0, -1.0), 100.0);
  rayQueryProceedEXT(query);
  float answer = -1.0;
  if (rayQueryGetIntersectionTypeEXT(query, true) != 0u) {
    float t = rayQueryGetIntersectionTEXT(query, true);
    vec2 weights = rayQueryGetIntersectionBarycentricsEXT(query, true);
    int primitive = rayQueryGetIntersectionPrimitiveIndexEXT(query, true);
    int custom = rayQueryGetIntersectionInstanceCustomIndexEXT(query, true);
    answer = t + weights.x + 2.0 * weights.y + float(primitive * 3 + custom);
  }
  result[i] = answer;
}
)";

std::vector<std::byte> bytes_of(std::span<const float> values) {
  const auto bytes = std::as_bytes(values);
  return {bytes.begin(), bytes.end()};
}

Job job_of(const char* name, const char* source) {
  std::vector<float> values;
  for (std::uint32_t i = 0; i < 2 * invocations; ++i)
    values.push_back(i % 11 == 0 ? static_cast<float>(i % 5) : static_cast<float>(i * 37 % 101) * 0.0373f - 1.3f);
  Job job;
  job.shaders = {{.name = name, .spirv = glsl::compile(source, rhi::ShaderStage::compute, name, {.debug_info = true})}};
  job.buffers = {{.name = "values", .initial = bytes_of(values)},
                 {.name = "result", .initial = std::vector<std::byte>(2 * invocations * sizeof(float))}};
  program::Pipeline pipeline;
  pipeline.name = name;
  pipeline.stages = program::ComputeStages{};
  pipeline.bindings = {{.set = 0, .binding = 0, .resource = BufferUse{.buffer = 0}},
                       {.set = 0, .binding = 1, .resource = BufferUse{.buffer = 1}}};
  job.pipelines = {std::move(pipeline)};
  job.commands = {program::Dispatch{.workgroup_count = {invocations / 16, 1, 1}}};
  return job;
}

/// Four triangles that make two squares, and a hole beside them.
Job ray_job() {
  Job job = job_of("rays", rays);
  job.bottom_levels = {
      {.name = "square",
       .geometries = {program::Triangles{.positions = {{0, 0, 0}, {0.5f, 0, 0}, {0, 1, 0}, {0.5f, 1, 0.25f}},
                                         .indices = {0, 1, 2, 2, 1, 3}}}}};
  program::Instance near{.bottom_level = 0, .custom_index = 20};
  near.object_to_world[3] = 0.45f;
  near.object_to_world[11] = 0.5f;
  job.top_levels = {{.name = "scene", .instances = {{.bottom_level = 0, .custom_index = 10}, near}}};
  job.pipelines[0].bindings.push_back({.set = 0, .binding = 2, .resource = program::TopLevelUse{0}});
  return job;
}

}  // namespace

std::vector<ExplainedShader> explained_shaders() {
  return {{"floats", job_of("floats", floats)},
          {"integers", job_of("integers", integers)},
          {"shared", job_of("shared", shared_memory)},
          {"control", job_of("control", control)},
          {"rays", ray_job()}};
}

}  // namespace tandem::test
