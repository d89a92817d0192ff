#version 460
// The acceleration of each body by all others, softened, through tiles of 256 bodies in shared memory (Nyland, Harris
// and Prins 2007).
layout(local_size_x = 256) in;
layout(set = 0, binding = 0, std430) writeonly buffer Answer { vec4 accelerations[]; };
layout(set = 0, binding = 1, std430) readonly buffer Bodies { vec4 bodies[]; };  // position and mass
layout(push_constant) uniform Constants { uint count; };

shared vec4 tile[256];

void main() {
  const vec3 position = bodies[gl_GlobalInvocationID.x].xyz;
  vec3 sum = vec3(0.0);
  for (uint first = 0; first < count; first += 256) {
    tile[gl_LocalInvocationID.x] = bodies[first + gl_LocalInvocationID.x];
    barrier();
    for (uint i = 0; i < 256; ++i) {
      const vec4 body = tile[i];
      const vec3 way = body.xyz - position;
      const float inverse = inversesqrt(dot(way, way) + 0.01);
      sum += way * (body.w * inverse * inverse * inverse);
    }
    barrier();
  }
  accelerations[gl_GlobalInvocationID.x] = vec4(sum, 0.0);
}
