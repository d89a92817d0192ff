#version 460
// After how many steps a point leaves the circle of radius 2, up to 256: each invocation's loop has a length of its
// own. `precise`, so that every device rounds alike and finds the same number.
layout(local_size_x = 16, local_size_y = 16) in;
layout(set = 0, binding = 0, std430) writeonly buffer Answer { uint steps[]; };
layout(push_constant) uniform Constants {
  uint side;
  float step_size;
};

void main() {
  const uvec2 at = gl_GlobalInvocationID.xy;
  precise const float cx = (float(at.x) + 0.5) * step_size - 2.0;
  precise const float cy = (float(at.y) + 0.5) * step_size - 1.25;
  precise float x = 0.0;
  precise float y = 0.0;
  uint count = 0;
  while (count < 256) {
    precise const float xx = x * x;
    precise const float yy = y * y;
    if (xx + yy > 4.0) break;
    y = 2.0 * x * y + cy;
    x = xx - yy + cx;
    ++count;
  }
  steps[at.y * side + at.x] = count;
}
