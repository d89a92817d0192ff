#version 460
// The discrete Fourier transform of 1024 complex numbers in each workgroup, in shared memory: Stockham's order, which
// needs no reversal of bits, with radix 4 (Govindaraju et al. 2008). roots[m] = exp(-2 pi i m / 1024): the sine and
// cosine of a device would be too inexact.
layout(local_size_x = 256) in;
layout(set = 0, binding = 0, std430) writeonly buffer Answer { vec2 spectrum[]; };
layout(set = 0, binding = 1, std430) readonly buffer Signal { vec2 signal[]; };
layout(set = 0, binding = 2, std430) readonly buffer Roots { vec2 roots[]; };

shared vec2 points[1024];

vec2 product(vec2 a, vec2 b) { return vec2(a.x * b.x - a.y * b.y, a.x * b.y + a.y * b.x); }

void main() {
  const uint local = gl_LocalInvocationID.x;
  const uint first = gl_WorkGroupID.x * 1024;
  for (uint i = 0; i < 4; ++i) points[local + 256 * i] = signal[first + local + 256 * i];
  for (uint size = 1; size < 1024; size *= 4) {
    barrier();
    const uint within = local & (size - 1);
    const uint angle = within * (256 / size);
    const vec2 a = points[local];
    const vec2 b = product(points[local + 256], roots[angle]);
    const vec2 c = product(points[local + 512], roots[2 * angle]);
    const vec2 d = product(points[local + 768], roots[3 * angle]);
    const vec2 even = a + c;
    const vec2 odd = a - c;
    const vec2 sum = b + d;
    const vec2 turned = vec2(b.y - d.y, d.x - b.x);  // -i (b - d)
    barrier();
    const uint to = (local - within) * 4 + within;
    points[to] = even + sum;
    points[to + size] = odd + turned;
    points[to + 2 * size] = even - sum;
    points[to + 3 * size] = odd - turned;
  }
  barrier();
  for (uint i = 0; i < 4; ++i) spectrum[first + local + 256 * i] = points[local + 256 * i];
}
