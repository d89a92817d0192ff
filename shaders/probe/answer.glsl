// What a device reports of the hit that a ray commits: compare/probe/answer.hpp says the same on the host.

#ifndef TANDEM_PROBE_ANSWER
#define TANDEM_PROBE_ANSWER

const uint ANSWER_MISS = 0;
const uint ANSWER_TRIANGLE = 1;
const uint ANSWER_SPHERE = 2;   // generated in its box
const uint ANSWER_MISSING = 3;  // no shader spoke, where one must

const uint HIT_KIND_FRONT = 0xfe;
const uint HIT_KIND_BACK = 0xff;
const uint HIT_KIND_SPHERE = 2;

struct ProbeAnswer {
  uint type;  // ANSWER_*; of a miss everything else is 0
  uint instance;
  uint custom_index;
  uint record;  // the instance's offset into the hit records, or the record that was run
  uint geometry;
  uint primitive;
  uint hit_kind;
  float t;
  float barycentrics[2];  // 0 of spheres
  float object_origin[3];
  float object_direction[3];
  float object_to_world[12];  // row-major 3x4
  float world_to_object[12];
};

ProbeAnswer empty_answer(uint type) {
  ProbeAnswer answer;
  answer.type = type;
  answer.instance = answer.custom_index = answer.record = answer.geometry = answer.primitive = answer.hit_kind = 0u;
  answer.t = answer.barycentrics[0] = answer.barycentrics[1] = 0.0;
  for (int i = 0; i < 3; ++i) answer.object_origin[i] = answer.object_direction[i] = 0.0;
  for (int i = 0; i < 12; ++i) answer.object_to_world[i] = answer.world_to_object[i] = 0.0;
  return answer;
}

void set_object_space(inout ProbeAnswer answer, vec3 origin, vec3 direction, mat4x3 object_to_world,
                      mat4x3 world_to_object) {
  for (int row = 0; row < 3; ++row) {
    answer.object_origin[row] = origin[row];
    answer.object_direction[row] = direction[row];
    for (int column = 0; column < 4; ++column) {
      answer.object_to_world[row * 4 + column] = object_to_world[column][row];
      answer.world_to_object[row * 4 + column] = world_to_object[column][row];
    }
  }
}

#endif
