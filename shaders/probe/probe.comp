// Asks one ray by a ray query, and stores all that the device reports of its hit.
#version 460
#extension GL_EXT_ray_query : require
#extension GL_GOOGLE_include_directive : require

layout(local_size_x = 64) in;

#include "probe/answer.glsl"
#include "probe/trial.glsl"

layout(set = 0, binding = 3, std430) writeonly buffer Answers { ProbeAnswer answers[]; };

void main() {
  uint index = gl_GlobalInvocationID.x;
  if (index >= trial.ray_count) return;
  ProbeRay ray = rays[index];
  rayQueryEXT query;
  rayQueryInitializeEXT(query, probe_scene, trial.flags, trial.mask, ray.origin, ray.t_min, ray.direction, ray.t_max);
  while (rayQueryProceedEXT(query)) {
    uint geometry = uint(rayQueryGetIntersectionGeometryIndexEXT(query, false));
    uint primitive = uint(rayQueryGetIntersectionPrimitiveIndexEXT(query, false));
    bool accepted = is_accepted(geometry, primitive);
    if (rayQueryGetIntersectionTypeEXT(query, false) == gl_RayQueryCandidateIntersectionAABBEXT) {
      float t = probe_sphere_hit(geometry, primitive, rayQueryGetIntersectionObjectRayOriginEXT(query, false),
                                 rayQueryGetIntersectionObjectRayDirectionEXT(query, false), ray.t_min);
      bool committed = rayQueryGetIntersectionTypeEXT(query, true) != gl_RayQueryCommittedIntersectionNoneEXT;
      float bound = committed ? rayQueryGetIntersectionTEXT(query, true) : ray.t_max;
      accepted = accepted || rayQueryGetIntersectionCandidateAABBOpaqueEXT(query);
      if (t > ray.t_min && t <= bound && accepted) rayQueryGenerateIntersectionEXT(query, t);
    } else if (accepted) {
      rayQueryConfirmIntersectionEXT(query);
    }
  }
  ProbeAnswer answer = empty_answer(ANSWER_MISS);
  uint type = rayQueryGetIntersectionTypeEXT(query, true);
  if (type != gl_RayQueryCommittedIntersectionNoneEXT) {
    answer.instance = uint(rayQueryGetIntersectionInstanceIdEXT(query, true));
    answer.custom_index = uint(rayQueryGetIntersectionInstanceCustomIndexEXT(query, true));
    answer.record = rayQueryGetIntersectionInstanceShaderBindingTableRecordOffsetEXT(query, true);
    answer.geometry = uint(rayQueryGetIntersectionGeometryIndexEXT(query, true));
    answer.primitive = uint(rayQueryGetIntersectionPrimitiveIndexEXT(query, true));
    answer.t = rayQueryGetIntersectionTEXT(query, true);
    set_object_space(answer, rayQueryGetIntersectionObjectRayOriginEXT(query, true),
                     rayQueryGetIntersectionObjectRayDirectionEXT(query, true),
                     rayQueryGetIntersectionObjectToWorldEXT(query, true),
                     rayQueryGetIntersectionWorldToObjectEXT(query, true));
  }
  if (type == gl_RayQueryCommittedIntersectionTriangleEXT) {
    answer.type = ANSWER_TRIANGLE;
    answer.hit_kind = rayQueryGetIntersectionFrontFaceEXT(query, true) ? HIT_KIND_FRONT : HIT_KIND_BACK;
    vec2 barycentrics = rayQueryGetIntersectionBarycentricsEXT(query, true);
    answer.barycentrics[0] = barycentrics.x;
    answer.barycentrics[1] = barycentrics.y;
  } else if (type == gl_RayQueryCommittedIntersectionGeneratedEXT) {
    answer.type = ANSWER_SPHERE;
    answer.hit_kind = HIT_KIND_SPHERE;
  }
  answers[index] = answer;
}
