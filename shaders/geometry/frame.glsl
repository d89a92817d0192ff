// The shading frame: an orthonormal basis in which the normal is z.

#ifndef TANDEM_GEOMETRY_FRAME
#define TANDEM_GEOMETRY_FRAME

#include "math.glsl"

struct Frame {
  vec3 tangent;
  vec3 bitangent;
  vec3 normal;
};

/// Any right-handed frame around a unit normal, without a singular direction (Duff et al., Building an Orthonormal
/// Basis, Revisited, JCGT 6(1), 2017).
precise Frame make_frame(vec3 normal) {
  float sign_z = normal.z < 0.0 ? -1.0 : 1.0;
  float a = det_div(-1.0, sign_z + normal.z);
  float b = normal.x * normal.y * a;
  Frame frame;
  frame.tangent = vec3(1.0 + sign_z * normal.x * normal.x * a, sign_z * b, -sign_z * normal.x);
  frame.bitangent = vec3(b, sign_z + normal.y * normal.y * a, -normal.y);
  frame.normal = normal;
  return frame;
}

precise vec3 to_local(Frame frame, vec3 v) {
  return vec3(det_dot(v, frame.tangent), det_dot(v, frame.bitangent), det_dot(v, frame.normal));
}

precise vec3 to_world(Frame frame, vec3 v) {
  return (frame.tangent * v.x + frame.bitangent * v.y) + frame.normal * v.z;
}

#endif
