// result = factor * x + y, one invocation for each element.
#version 460

layout(local_size_x = 64) in;
layout(constant_id = 0) const bool negate = false;

layout(set = 0, binding = 0) readonly buffer X { float x[]; };
layout(set = 0, binding = 1) readonly buffer Y { float y[]; };
layout(set = 0, binding = 2) writeonly buffer Result { float result[]; };
layout(push_constant) uniform Constants {
  float factor;
  uint count;
};

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i < count) result[i] = (negate ? -factor : factor) * x[i] + y[i];
}
