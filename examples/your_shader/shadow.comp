// Which points of a plane are in the shadow of the triangle above it? One word for each invocation, 1 or 0.
#version 460
#extension GL_EXT_ray_query : require

layout(local_size_x = 16) in;
layout(set = 0, binding = 0) uniform accelerationStructureEXT tlas;
layout(set = 0, binding = 1, std430) buffer Shadow { uint shadow[]; };

void main() {
  uint i = gl_GlobalInvocationID.x;
  vec3 origin = vec3((float(i) + 0.5) / 16.0, 0.0, 0.25);
  rayQueryEXT query;
  rayQueryInitializeEXT(query, tlas, gl_RayFlagsTerminateOnFirstHitEXT | gl_RayFlagsOpaqueEXT, 0xFF, origin, 0.0,
                        vec3(0.0, 1.0, 0.0), 100.0);
  rayQueryProceedEXT(query);
  shadow[i] = rayQueryGetIntersectionTypeEXT(query, true) == gl_RayQueryCommittedIntersectionNoneEXT ? 0u : 1u;
}
