// Ray queries as the translator passes them on: operands, getters, queries in arrays and as parameters. What a query
// does with its hits is tested with kernel/ray_query.hpp itself.

#include <cstdint>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "rhi_cpu/kernel/trace.hpp"
#include "tests/rhi_cpu/translate/assembly.hpp"
#include "tests/rhi_cpu/translate/kernel_harness.hpp"

namespace {

namespace kernel = tandem::kernel;
using tandem::test::Kernel;
using tandem::test::resource;

/// A scene in which every ray whose direction points to +z hits one opaque triangle at t = 2 * origin.x.
bool closest(const kernel::TopLevel&, const kernel::Ray& ray, kernel::Hit& hit) {
  if (ray.direction[2] <= 0 || ray.mask != 0x7f) return false;
  hit = {.t = 2 * ray.origin[0],
         .barycentrics = {0.25f, 0.5f},
         .instance_index = 1,
         .geometry_index = 5,
         .primitive_index = 9,
         .front_face = true,
         .opaque = true,
         .is_box = false};
  return true;
}
bool occluded(const kernel::TopLevel& scene, const kernel::Ray& ray) {
  kernel::Hit hit;
  return closest(scene, ray, hit);
}
std::uint32_t next(const kernel::TopLevel& scene, const kernel::Ray& ray, const kernel::Hit* previous,
                   kernel::Hit* hits, std::uint32_t) {
  return previous == nullptr && closest(scene, ray, hits[0]) ? 1 : 0;
}

constexpr kernel::TraceFunctions functions = {closest, occluded, next, nullptr, nullptr, nullptr};
constexpr kernel::Instance instances[2] = {
    {}, {{{1, 0, 0, 10}, {0, 1, 0, 20}, {0, 0, 1, 30}}, {{1, 0, 0, -10}, {0, 1, 0, -20}, {0, 0, 1, -30}}, 42, 77}};

TEST_CASE("queries and structures go through variables, arrays and parameters") {
  const kernel::TopLevel scenes[2] = {{&functions, instances, 2, true, false}, {&functions, instances, 2, true, false}};
  const Kernel kernel(R"(
    #extension GL_EXT_ray_query : require
    layout(local_size_x = 1) in;
    layout(binding = 0) uniform accelerationStructureEXT scene;
    layout(binding = 1) uniform accelerationStructureEXT scenes[2];
    layout(std430, binding = 2) buffer Result { float result[]; };
    void start(rayQueryEXT query, vec3 origin, vec3 direction) {
      rayQueryInitializeEXT(query, scene, gl_RayFlagsOpaqueEXT, 0x7f, origin, 0.125, direction, 100.0);
      rayQueryProceedEXT(query);
    }
    float start_one(rayQueryEXT query, float x, float t_max) {
      start(query, vec3(x, 0, 0), vec3(0, 0, 1));
      if (t_max == 9.0) return rayQueryGetIntersectionTEXT(query, true);
      return -rayQueryGetIntersectionTEXT(query, true);
    }
    bool hits(rayQueryEXT query) {
      return rayQueryGetIntersectionTypeEXT(query, true) == gl_RayQueryCommittedIntersectionTriangleEXT;
    }
    void main() {
      rayQueryEXT one, many[2];
      start(one, vec3(3, 4, 5), vec3(0, 0.5, 1));
      rayQueryInitializeEXT(many[0], scene, 0u, 0x7f, vec3(1), 0.0, vec3(0, 0, -1), 100.0);
      rayQueryProceedEXT(many[0]);
      int n = result.length() / 30;
      rayQueryInitializeEXT(many[n], scenes[n], 0u, 0x7f, vec3(8, 0, 0), 0.0, vec3(0, 0, 2), 100.0);
      rayQueryProceedEXT(many[n]);
      result[0] = float(hits(one)); result[1] = float(rayQueryGetIntersectionTypeEXT(many[0], true)); result[2] = float(rayQueryGetIntersectionTypeEXT(many[n], true));
      result[3] = rayQueryGetIntersectionTEXT(one, true); result[4] = rayQueryGetIntersectionTEXT(many[n], true);
      result[5] = rayQueryGetRayTMinEXT(one); result[6] = float(rayQueryGetRayFlagsEXT(one));
      result[7] = rayQueryGetWorldRayOriginEXT(one).y; result[8] = rayQueryGetWorldRayDirectionEXT(one).y;
      result[9] = float(rayQueryGetIntersectionInstanceCustomIndexEXT(one, true));
      result[10] = float(rayQueryGetIntersectionInstanceIdEXT(one, true));
      result[11] = float(rayQueryGetIntersectionInstanceShaderBindingTableRecordOffsetEXT(one, true));
      result[12] = float(rayQueryGetIntersectionGeometryIndexEXT(one, true));
      result[13] = float(rayQueryGetIntersectionPrimitiveIndexEXT(one, true));
      result[14] = rayQueryGetIntersectionBarycentricsEXT(one, true).y;
      result[15] = float(rayQueryGetIntersectionFrontFaceEXT(one, true));
      result[16] = rayQueryGetIntersectionObjectRayOriginEXT(one, true).z;
      result[17] = rayQueryGetIntersectionObjectRayDirectionEXT(one, true).z;
      mat4x3 to_world = rayQueryGetIntersectionObjectToWorldEXT(one, true);
      result[18] = to_world[3][2];
      result[19] = rayQueryGetIntersectionWorldToObjectEXT(one, true)[3].y;
      result[20] = start_one(many[n], float(n), 9.0); result[21] = start_one(many[0], 5.0, 0.5);
    })");
  std::vector<float> result(30);
  kernel::TopLevel* const scene = const_cast<kernel::TopLevel*>(scenes);
  kernel.run({{reinterpret_cast<std::byte*>(scene), 0},
              {reinterpret_cast<std::byte*>(scene), 0},
              {reinterpret_cast<std::byte*>(scene + 1), 0},
              resource(result)});
  result.resize(22);
  CHECK(result ==
        std::vector<float>{1, 0, 1, 6, 16, 0.125f, 1, 4, 0.5f, 42, 1, 77, 5, 9, 0.5f, 1, -25, 1, 30, -20, 2, -10});
}

/// Two boxes, an opaque one at t = 2 and one that is not at t = 3, then a triangle that needs a confirmation at t = 4.
std::uint32_t next_candidates(const kernel::TopLevel&, const kernel::Ray&, const kernel::Hit* previous,
                              kernel::Hit* hits, std::uint32_t capacity) {
  std::uint32_t count = 0;
  for (std::uint32_t i = 0; i < 3 && count < capacity; ++i) {
    const float t = static_cast<float>(i + 2);
    if (previous != nullptr && t <= previous->t) continue;
    hits[count++] = {.t = t,
                     .barycentrics = {0, 0},
                     .instance_index = 0,
                     .geometry_index = 0,
                     .primitive_index = i,
                     .front_face = true,
                     .opaque = i == 0,
                     .is_box = i < 2};
  }
  return count;
}

TEST_CASE("candidates are asked for, confirmed and generated, with structures from an array under any index") {
  constexpr kernel::TraceFunctions with_candidates = {closest, occluded, next_candidates, nullptr, nullptr, nullptr};
  const kernel::TopLevel scenes[2] = {{&functions, instances, 2, true, false},
                                      {&with_candidates, instances, 2, false, true}};
  const Kernel kernel(R"(
    #extension GL_EXT_ray_query : require
    #extension GL_EXT_nonuniform_qualifier : require
    layout(local_size_x = 2) in;
    layout(binding = 0) uniform accelerationStructureEXT scenes[2];
    layout(std430, binding = 1) buffer Result { float result[]; };
    void main() {
      uint n = gl_LocalInvocationIndex;
      rayQueryEXT query;
      rayQueryInitializeEXT(query, scenes[nonuniformEXT(n)], 0u, 0x7f, vec3(1), 0.0, vec3(0, 0, 1), 100.0);
      uint i = n * 16;
      while (rayQueryProceedEXT(query)) {
        uint type = rayQueryGetIntersectionTypeEXT(query, false);
        result[i++] = float(type) + 10.0 * float(rayQueryGetIntersectionPrimitiveIndexEXT(query, false));
        if (type == gl_RayQueryCandidateIntersectionAABBEXT) {
          result[i++] = float(rayQueryGetIntersectionCandidateAABBOpaqueEXT(query));
          rayQueryGenerateIntersectionEXT(query, 5.5 - float(i - n * 16));
        } else {
          rayQueryConfirmIntersectionEXT(query);
        }
      }
      result[i++] = float(rayQueryGetIntersectionTypeEXT(query, true));
      result[i++] = rayQueryGetIntersectionTEXT(query, true);
    })");
  std::vector<float> result(32, -1);
  kernel.run({{const_cast<std::byte*>(reinterpret_cast<const std::byte*>(&scenes[0])), 0},
              {const_cast<std::byte*>(reinterpret_cast<const std::byte*>(&scenes[1])), 0},
              resource(result)});
  CHECK(std::vector<float>(result.begin(), result.begin() + 3) == std::vector<float>{1, 2, -1});
  // The second box is generated at 1.5 instead of 3.5, and what is behind is met no more.
  CHECK(std::vector<float>(result.begin() + 16, result.begin() + 23) == std::vector<float>{1, 1, 11, 0, 2, 1.5f, -1});
}

TEST_CASE("a structure is made of an address in a loop and used behind it") {
  const std::string text = R"(
OpCapability Shader
OpCapability RayQueryKHR
OpExtension "SPV_KHR_ray_query"
OpMemoryModel Logical GLSL450
OpEntryPoint GLCompute %main "main" %buffer %query
OpExecutionMode %main LocalSize 1 1 1
OpDecorate %block Block
OpMemberDecorate %block 0 Offset 0
OpMemberDecorate %block 1 Offset 8
OpMemberDecorate %block 2 Offset 12
OpDecorate %buffer DescriptorSet 0
OpDecorate %buffer Binding 0
%void = OpTypeVoid
%signature = OpTypeFunction %void
%bool = OpTypeBool
%uint = OpTypeInt 32 0
%float = OpTypeFloat 32
%uvec2 = OpTypeVector %uint 2
%vec3 = OpTypeVector %float 3
%scene_type = OpTypeAccelerationStructureKHR
%query_type = OpTypeRayQueryKHR
%query_pointer = OpTypePointer Private %query_type
%block = OpTypeStruct %uvec2 %uint %float
%pointer = OpTypePointer StorageBuffer %block
%address_pointer = OpTypePointer StorageBuffer %uvec2
%uint_pointer = OpTypePointer StorageBuffer %uint
%float_pointer = OpTypePointer StorageBuffer %float
%zero = OpConstant %uint 0
%one = OpConstant %uint 1
%two = OpConstant %uint 2
%mask = OpConstant %uint 127
%f0 = OpConstant %float 0
%f1 = OpConstant %float 1
%f3 = OpConstant %float 3
%f100 = OpConstant %float 100
%origin = OpConstantComposite %vec3 %f3 %f0 %f0
%direction = OpConstantComposite %vec3 %f0 %f0 %f1
%buffer = OpVariable %pointer StorageBuffer
%query = OpVariable %query_pointer Private
%main = OpFunction %void None %signature
%entry = OpLabel
OpBranch %header
%header = OpLabel
%i = OpPhi %uint %zero %entry %next %continue
OpLoopMerge %done %continue None
OpBranch %inside
%inside = OpLabel
%place = OpAccessChain %address_pointer %buffer %zero
%words = OpLoad %uvec2 %place
%scene = OpConvertUToAccelerationStructureKHR %scene_type %words
%count_place = OpAccessChain %uint_pointer %buffer %one
%count = OpLoad %uint %count_place
%enough = OpUGreaterThanEqual %bool %i %count
OpBranchConditional %enough %done %continue
%continue = OpLabel
%next = OpIAdd %uint %i %one
OpBranch %header
%done = OpLabel
OpRayQueryInitializeKHR %query %scene %one %mask %origin %f0 %direction %f100
%proceeds = OpRayQueryProceedKHR %bool %query
%t = OpRayQueryGetIntersectionTKHR %float %query %one
%result = OpAccessChain %float_pointer %buffer %two
OpStore %result %t
OpReturn
OpFunctionEnd
)";
  const kernel::TopLevel scene = {&functions, instances, 2, true, false};
  const kernel::AddressedTopLevel addressed = {&scene};
  struct {
    const kernel::AddressedTopLevel* address;
    std::uint32_t count;
    float result;
  } memory = {&addressed, 2, 0};
  for (const bool optimize : {false, true}) {
    CAPTURE(optimize);
    memory.result = 0;
    tandem::test::KernelOptions options;
    options.optimize = optimize;
    Kernel(tandem::test::assembled(text), options).run({{reinterpret_cast<std::byte*>(&memory), sizeof(memory)}});
    CHECK(memory.result == 6);
  }
}

}  // namespace
