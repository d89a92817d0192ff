// Ray queries as the translator passes them on: operands, getters, queries in arrays and as parameters. What a query
// does with its hits is tested with kernel/ray_query.hpp itself.

#include <cstdint>
#include <vector>

#include <doctest/doctest.h>

#include "rhi_cpu/kernel/trace.hpp"
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

constexpr kernel::TraceFunctions functions = {closest, occluded, next, nullptr};
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
    })");
  std::vector<float> result(30);
  kernel::TopLevel* const scene = const_cast<kernel::TopLevel*>(scenes);
  kernel.run({{reinterpret_cast<std::byte*>(scene), 0},
              {reinterpret_cast<std::byte*>(scene), 0},
              {reinterpret_cast<std::byte*>(scene + 1), 0},
              resource(result)});
  result.resize(20);
  CHECK(result == std::vector<float>{1, 0, 1, 6, 16, 0.125f, 1, 4, 0.5f, 42, 1, 77, 5, 9, 0.5f, 1, -25, 1, 30, -20});
}

}  // namespace
