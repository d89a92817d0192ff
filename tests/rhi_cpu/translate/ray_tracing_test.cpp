// The stages of a ray tracing pipeline as the translator prints them: what a shader passes on, what it is given, and
// how it ends. Each with a plain and an optimised module. What a pipeline does with all that is tested with the device.

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "rhi_cpu/kernel/shader_call.hpp"
#include "tests/rhi_cpu/translate/recording_host.hpp"

namespace {

namespace kernel = tandem::kernel;
using kernel::HitDecision;
using kernel::ShaderCall;
using tandem::rhi::ShaderStage;
using tandem::test::call_of;
using tandem::test::Kernel;
using tandem::test::kernels;
using tandem::test::RecordingHost;
using tandem::test::resource;
using tandem::test::traced_spirv;

std::byte* bytes_of(const kernel::TopLevel& scene) {
  return const_cast<std::byte*>(reinterpret_cast<const std::byte*>(&scene));
}

TEST_CASE("a ray generation shader has its launch, resources, constants and record, and passes on its operands") {
  const auto shaders = kernels(R"(
    layout(location = 3) rayPayloadEXT vec3 color;
    layout(location = 4) callableDataEXT uvec2 data;
    layout(binding = 0) uniform accelerationStructureEXT scenes[2];
    layout(std430, binding = 1) buffer Result { float result[]; };
    layout(push_constant) uniform Constants { vec3 origin; uint flags; };
    layout(shaderRecordEXT, std430) buffer Record { float unused; vec3 direction[2]; mat2x3 turn; };
    void main() {
      color = vec3(1, 2, 3);
      traceRayEXT(scenes[gl_LaunchIDEXT.y], flags, 0x1ff, 0x13, 0x25, 0x12345u, origin, 0.5, direction[1], 100.0, 3);
      data = uvec2(7, 8);
      executeCallableEXT(70000u, 4);
      result[0] = color.x; result[1] = color.y; result[2] = float(gl_LaunchIDEXT.x);
      result[3] = float(gl_LaunchSizeEXT[gl_LaunchIDEXT.y + 1]);
      result[4] = turn[1].z;
    })",
                               ShaderStage::ray_generation);
  for (const auto& shader : shaders) {
    CHECK(shader->info().stage == kernel::Stage::ray_generation);
    CHECK((shader->info().run == nullptr));
    CHECK(shader->info().push_constant_size == 16);
    CHECK(shader->info().shader_record_size == 80);
    CHECK(shader->info().payload_size == 0);
    const kernel::TopLevel scenes[2] = {{nullptr, nullptr, 0, true, false}, {nullptr, nullptr, 0, true, false}};
    std::vector<float> result(5), record(20);
    std::fill(record.begin(), record.end(), -1.0f);
    std::copy_n(std::begin({4.0f, 5.0f, 6.0f}), 3, record.begin() + 8);
    record[18] = 9;
    const std::array<std::uint32_t, 4> constants = {0x3f800000, 0x40000000, 0x40400000, 0x11};
    const kernel::Resource resources[] = {{bytes_of(scenes[0]), 0}, {bytes_of(scenes[1]), 0}, resource(result)};
    RecordingHost host;
    ShaderCall call = call_of(host);
    call.resources = resources;
    call.push_constants = reinterpret_cast<const std::byte*>(constants.data());
    call.shader_record = reinterpret_cast<const std::byte*>(record.data());
    call.launch_id[0] = 11;
    call.launch_id[1] = 1;
    call.launch_size[0] = 12;
    call.launch_size[2] = 14;
    shader->call(call);
    REQUIRE(host.traces.size() == 1);
    const RecordingHost::Trace& trace = host.traces[0];
    CHECK(trace.scene == &scenes[1]);
    CHECK(trace.ray.flags == 0x11);
    CHECK(trace.ray.mask == 0xff);          // 8 bits
    CHECK(trace.sbt_record_offset == 0x3);  // 4 bits
    CHECK(trace.sbt_record_stride == 0x5);  // 4 bits
    CHECK(trace.miss_index == 0x2345);      // 16 bits
    CHECK(std::vector<float>(trace.ray.origin, trace.ray.origin + 3) == std::vector<float>{1, 2, 3});
    CHECK(std::vector<float>(trace.ray.direction, trace.ray.direction + 3) == std::vector<float>{4, 5, 6});
    CHECK(trace.ray.t_min == 0.5f);
    CHECK(trace.ray.t_max == 100);
    CHECK(trace.payload_size == 12);
    CHECK(host.callable_indices == std::vector<std::uint32_t>{70000});
    CHECK(host.data_sizes == std::vector<std::uint32_t>{8});
    CHECK(result == std::vector<float>{1, 2, 11, 14, 9});
  }
}

constexpr const char* payload_block = R"(
    #extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
    struct Inner { bool flag; vec3 position; bvec2 flags; };
    struct Payload { float first; Inner inner[2]; mat3x2 matrix; bool last[3]; uint64_t wide; int depth; Inner one; };
)";

TEST_CASE("a payload has one layout in every module, with nested structures, arrays, booleans and matrices") {
  const auto callers = kernels(std::string(payload_block) + R"(
    layout(location = 0) rayPayloadEXT Payload payload;
    layout(binding = 0) uniform accelerationStructureEXT scene;
    layout(std430, binding = 1) buffer Result { float result[]; };
    void main() {
      payload.first = 1.0; payload.inner[1].flag = true; payload.inner[1].position = vec3(2, 3, 4);
      payload.inner[1].flags = bvec2(false, true); payload.matrix = mat3x2(1, 2, 3, 4, 5, 6);
      payload.last[2] = true; payload.wide = 0x100000002ul; payload.depth = -7; payload.one = payload.inner[1];
      traceRayEXT(scene, 0, 0xff, 0, 0, 0, vec3(0), 0.0, vec3(1), 1.0, 0);
      result[0] = payload.first; result[1] = float(payload.inner[0].flag); result[2] = payload.inner[0].position.z;
      result[3] = float(payload.inner[0].flags.y); result[4] = payload.matrix[2].x; result[5] = float(payload.last[0]);
      result[6] = float(payload.wide); result[7] = float(payload.depth); result[8] = payload.one.position.y;
      result[9] = float(payload.inner[1].flag);
    })",
                               ShaderStage::ray_generation);
  const auto called = kernels(std::string(payload_block) + R"(
    layout(location = 0) rayPayloadInEXT Payload incoming;
    hitAttributeEXT vec2 unused;
    void main() {
      if (incoming.first != 1.0 || !incoming.inner[1].flag || incoming.inner[1].position != vec3(2, 3, 4) ||
          incoming.inner[1].flags != bvec2(false, true) || incoming.matrix != mat3x2(1, 2, 3, 4, 5, 6) ||
          !incoming.last[2] || incoming.wide != 0x100000002ul || incoming.depth != -7 ||
          incoming.one.position != vec3(2, 3, 4)) return;
      incoming.first = 10.0; incoming.inner[0] = Inner(true, vec3(20, 30, 40), bvec2(false, true));
      incoming.matrix[2].x = 50.0; incoming.last[0] = true; incoming.wide = 60ul; incoming.depth = 70;
      incoming.one.position.y = 80.0;
    })",
                              ShaderStage::closest_hit);
  const kernel::TopLevel scene = {nullptr, nullptr, 0, true, false};
  for (const auto& caller : callers) {
    for (const auto& callee : called) {
      std::vector<float> result(10);
      const kernel::Resource resources[] = {{bytes_of(scene), 0}, resource(result)};
      RecordingHost host;
      host.hit_shader = callee.get();
      ShaderCall call = call_of(host);
      call.resources = resources;
      alignas(16) std::array<std::byte, kernel::max_hit_attribute_size> attributes = {};
      call.hit_attributes = attributes.data();
      caller->call(call);
      REQUIRE(host.traces.size() == 1);
      CHECK(host.traces[0].payload_size == callee->info().payload_size);
      CHECK(result == std::vector<float>{10, 1, 40, 1, 50, 1, 60, 70, 80, 1});
    }
  }
}

TEST_CASE("a closest-hit shader knows its hit, its instance and its ray") {
  const auto shaders = kernels(R"(
    #extension GL_EXT_ray_cull_mask : require
    layout(location = 0) rayPayloadInEXT float result[60];
    hitAttributeEXT vec2 barycentrics;
    void write3(int i, vec3 v) { result[i] = v.x; result[i + 1] = v.y; result[i + 2] = v.z; }
    void main() {
      result[0] = float(gl_InstanceID); result[1] = float(gl_InstanceCustomIndexEXT);
      result[2] = float(gl_GeometryIndexEXT); result[3] = float(gl_PrimitiveID); result[4] = float(gl_HitKindEXT);
      result[5] = gl_RayTminEXT; result[6] = gl_RayTmaxEXT; result[7] = gl_HitTEXT;
      result[8] = float(gl_IncomingRayFlagsEXT); result[9] = float(gl_CullMaskEXT);
      result[10] = barycentrics.x; result[11] = barycentrics.y;
      write3(12, gl_WorldRayOriginEXT); write3(15, gl_WorldRayDirectionEXT);
      write3(18, gl_ObjectRayOriginEXT); write3(21, gl_ObjectRayDirectionEXT);
      for (int column = 0; column < 4; ++column) {
        write3(24 + 3 * column, gl_ObjectToWorldEXT[column]); write3(36 + 3 * column, gl_WorldToObjectEXT[column]);
      }
      result[48] = gl_ObjectToWorld3x4EXT[1].w; result[49] = gl_WorldToObject3x4EXT[2].w;
      result[50] = float(gl_LaunchIDEXT.z); result[51] = float(gl_LaunchSizeEXT.z);
    })",
                               ShaderStage::closest_hit);
  const kernel::Hit hit = {.t = 1,
                           .barycentrics = {0.25f, 0.5f},
                           .instance_index = 3,
                           .geometry_index = 5,
                           .primitive_index = 6,
                           .front_face = true,
                           .opaque = true,
                           .is_box = false};
  const kernel::Instance instance = {{{1, 2, 3, 4}, {5, 6, 7, 8}, {9, 10, 11, 12}},
                                     {{0.1f, 0.2f, 0.3f, 0.4f}, {1.1f, 1.2f, 1.3f, 1.4f}, {2.1f, 2.2f, 2.3f, 2.4f}},
                                     42,
                                     77};
  kernel::Ray ray = {};
  std::copy_n(std::begin({1.1f, 2.3f, 3.7f}), 3, ray.origin);
  std::copy_n(std::begin({0.3f, 0.7f, 0.9f}), 3, ray.direction);
  ray.t_min = 0.125f;
  ray.t_max = 1000;
  ray.flags = 0x11;
  ray.mask = 0x7f;
  for (const auto& shader : shaders) {
    CHECK(shader->info().payload_size == 240);
    std::array<float, 60> result = {};
    alignas(16) std::array<float, 8> attributes = {0.25f, 0.5f};
    RecordingHost host;
    ShaderCall call = call_of(host);
    call.payload = result.data();
    call.payload_size = sizeof(result);
    call.hit_attributes = attributes.data();
    call.ray = &ray;
    call.t = 7;
    call.hit_kind = kernel::hit_kind_front_facing_triangle;
    call.hit = &hit;
    call.instance = &instance;
    call.launch_id[2] = 8;
    call.launch_size[2] = 9;
    shader->call(call);
    std::vector<float> expected = {3,    42,   5,    6,    0xfe, 0.125f, 7,    7,    0x11,
                                   0x7f, 0.25, 0.5f, 1.1f, 2.3f, 3.7f,   0.3f, 0.7f, 0.9f};
    // In the order of rayQueryGetIntersectionObjectRayOriginEXT, to the last bit.
    for (const auto& m : instance.world_to_object)
      expected.push_back(((m[3] + m[0] * ray.origin[0]) + m[1] * ray.origin[1]) + m[2] * ray.origin[2]);
    for (const auto& m : instance.world_to_object)
      expected.push_back((m[0] * ray.direction[0] + m[1] * ray.direction[1]) + m[2] * ray.direction[2]);
    for (int column = 0; column < 4; ++column)
      for (const auto& row : instance.object_to_world) expected.push_back(row[column]);
    for (int column = 0; column < 4; ++column)
      for (const auto& row : instance.world_to_object) expected.push_back(row[column]);
    for (const float value : {8.0f, 2.4f, 8.0f, 9.0f}) expected.push_back(value);
    expected.resize(60);
    CHECK(std::vector<float>(result.begin(), result.end()) == expected);
  }
}

/// The decision of an any-hit shader with `statements` for the payload (x, y), and the payload that it leaves.
struct AnyHit {
  explicit AnyHit(const std::string& declarations, const std::string& statements)
      : shaders(kernels("layout(location = 0) rayPayloadInEXT vec2 payload;\nhitAttributeEXT vec2 barycentrics;\n" +
                            declarations + "\nvoid main() {\n" + statements + "\n}",
                        ShaderStage::any_hit)) {}

  void check(float x, HitDecision decision, std::array<float, 2> left) const {
    for (const auto& shader : shaders) {
      CAPTURE(x);
      std::array<float, 2> payload = {x, 0};
      RecordingHost host;
      ShaderCall call = call_of(host);
      alignas(16) std::array<float, 8> attributes = {x};
      call.payload = payload.data();
      call.hit_attributes = attributes.data();
      shader->call(call);
      CHECK(call.decision == decision);
      CHECK(payload == left);
    }
  }

  std::array<std::unique_ptr<Kernel>, 2> shaders;
};

TEST_CASE("an any-hit shader accepts, ignores and terminates") {
  const AnyHit shader("", R"(
    payload.y = 1.0;
    if (barycentrics.x == 1.0) ignoreIntersectionEXT;
    payload.y = 2.0;
    if (barycentrics.x == 2.0) terminateRayEXT;
    payload.y = 3.0;)");
  shader.check(0, HitDecision::accept, {0, 3});
  shader.check(1, HitDecision::ignore, {1, 1});
  shader.check(2, HitDecision::terminate, {2, 2});
  AnyHit("", "payload.y = 1.0; ignoreIntersectionEXT;").check(5, HitDecision::ignore, {5, 1});
  AnyHit("", "payload.y = 1.0; terminateRayEXT;").check(5, HitDecision::terminate, {5, 1});
}

TEST_CASE("an any-hit shader ends from any depth of calls, loops and switches") {
  const AnyHit shader(R"(
    struct Pair { float a, b; };
    float deepest(float x) {
      for (int i = 0; i < 10; ++i) {
        switch (i) {
          case 2: if (x == 1.0) ignoreIntersectionEXT; break;
          case 3: if (x == 2.0) terminateRayEXT; break;
          default: payload.y += 1.0;
        }
        if (x == 3.0 && i == 5) ignoreIntersectionEXT;
      }
      return x;
    }
    Pair middle(float x) { Pair p; p.a = deepest(x); payload.y += 100.0; p.b = 1.0; return p; }
    void outer(float x) { while (payload.x < 20.0) { Pair p = middle(x); payload.x += p.a + p.b; } }
    )",
                      "outer(payload.x); payload.y += 1000.0;");
  shader.check(1, HitDecision::ignore, {1, 2});
  shader.check(2, HitDecision::terminate, {2, 2});
  shader.check(3, HitDecision::ignore, {3, 4});
  shader.check(19, HitDecision::accept, {39, 1108});
}

TEST_CASE("an any-hit shader ends from conditions and from what a loop does last") {
  const AnyHit shader(R"(
    int step(int i) { payload.y += 1.0; if (payload.x == float(i)) ignoreIntersectionEXT; return i + 1; }
    bool more(int i) { if (payload.x == float(-i)) terminateRayEXT; return i < 5; })",
                      "for (int i = 0; more(i); i = step(i)) payload.y += 10.0;\npayload.y += 100.0;");
  shader.check(9, HitDecision::accept, {9, 155});
  shader.check(3, HitDecision::ignore, {3, 44});
  shader.check(-2, HitDecision::terminate, {-2, 22});
}

TEST_CASE("an intersection shader reports hits with their attributes and ends where the host says") {
  const auto shaders = kernels(R"(
    struct Attributes { vec3 normal; int kind; };
    hitAttributeEXT Attributes attributes;
    layout(std430, binding = 0) buffer Result { float result[]; };
    bool report(float t, uint kind) { attributes.kind = int(kind) + 100; return reportIntersectionEXT(t, kind); }
    void main() {
      result[0] = 1.0;
      attributes.normal = gl_ObjectRayOriginEXT;
      result[1] = float(report(1.0, 7u));
      result[2] = gl_RayTmaxEXT;
      result[3] = float(report(9.0, 8u));
      result[4] = 1.0;
      result[5] = float(reportIntersectionEXT(2.0, 9u));
      result[6] = 1.0;
    })",
                               ShaderStage::intersection);
  const kernel::Instance instance = {{}, {{1, 0, 0, 10}, {0, 1, 0, 20}, {0, 0, 1, 30}}, 0, 0};
  const kernel::Ray ray = {{1, 2, 3}, 0, {0, 0, 1}, 100, 0, 0xff};
  for (const auto& shader : shaders) {
    CHECK(shader->info().stage == kernel::Stage::intersection);
    CHECK(shader->info().payload_size == 0);
    const auto run = [&](float terminating_t, RecordingHost& host) {
      std::vector<float> result(7);
      const kernel::Resource resources[] = {resource(result)};
      alignas(16) std::array<float, 8> attributes = {};
      host.terminating_t = terminating_t;
      ShaderCall call = call_of(host);
      call.resources = resources;
      call.hit_attributes = attributes.data();
      call.ray = &ray;
      call.t = 6;
      call.instance = &instance;
      shader->call(call);
      return result;
    };
    RecordingHost host;
    CHECK(run(-1, host) == std::vector<float>{1, 1, 6, 0, 1, 1, 1});
    REQUIRE(host.reports.size() == 3);
    CHECK(host.reports[1].t == 9);
    CHECK(host.reports[1].hit_kind == 8);
    CHECK(host.reports[2].hit_kind == 9);
    CHECK(host.reports[0].attributes[0] == 11);
    CHECK(host.reports[0].attributes[2] == 33);
    std::int32_t kind;
    std::memcpy(&kind, &host.reports[1].attributes[3], sizeof(kind));
    CHECK(kind == 108);
    RecordingHost in_function, in_main;
    CHECK(run(9, in_function) == std::vector<float>{1, 1, 6, 0, 0, 0, 0});
    CHECK(in_function.reports.size() == 2);
    CHECK(run(2, in_main) == std::vector<float>{1, 1, 6, 0, 1, 0, 0});
  }
}

TEST_CASE("miss and callable shaders change what they are given, and trace and call on") {
  const auto misses = kernels(R"(
    layout(location = 0) rayPayloadInEXT vec4 incoming;
    layout(location = 1) callableDataEXT vec2 data;
    layout(binding = 0) uniform accelerationStructureEXT scene;
    void main() {
      incoming.x += gl_RayTmaxEXT + gl_WorldRayDirectionEXT.y;
      data = vec2(incoming.x, 1);
      executeCallableEXT(4, 1);
      incoming.yz = data;
      traceRayEXT(scene, 0, 0xff, 0, 0, 1, gl_WorldRayOriginEXT, 0.0, vec3(1), 1.0, 0);
      incoming.w = 1.0;
    })",
                              ShaderStage::miss);
  const auto callables = kernels(R"(
    layout(location = 0) callableDataInEXT vec2 data;
    void add(inout vec2 v) { v += vec2(100, 200); }
    void main() { add(data); data.y += float(gl_LaunchIDEXT.x); })",
                                 ShaderStage::callable);
  const kernel::Ray ray = {{1, 2, 3}, 0, {0, 0.5f, 1}, 100, 0, 0xff};
  const kernel::TopLevel scene = {nullptr, nullptr, 0, true, false};
  const kernel::Resource resources[] = {{bytes_of(scene), 0}};
  for (std::size_t i = 0; i < 2; ++i) {
    CHECK(misses[i]->info().payload_size == 16);
    CHECK(callables[i]->info().payload_size == 8);
    CHECK(callables[i]->info().stage == kernel::Stage::callable);
    RecordingHost host;
    host.callable_shader = callables[i].get();
    std::array<float, 4> payload = {10, 0, 0, 0};
    ShaderCall call = call_of(host);
    call.resources = resources;
    call.payload = payload.data();
    call.ray = &ray;
    call.t = 100;
    call.launch_id[0] = 3;
    misses[i]->call(call);
    CHECK(payload == std::array<float, 4>{110.5f, 210.5f, 204, 1});
    REQUIRE(host.traces.size() == 1);
    CHECK(host.traces[0].payload_size == 16);
    CHECK(host.traces[0].miss_index == 1);
    CHECK(host.traces[0].ray.origin[2] == 3);
  }
}

}  // namespace
