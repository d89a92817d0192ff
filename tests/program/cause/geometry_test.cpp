#include <doctest/doctest.h>

#include <array>
#include <cmath>

#include <spirv_cross/GLSL.std.450.h>

#include "tests/program/cause/probe.hpp"

using namespace tandem::program;
using namespace tandem::program::testing;

namespace {

using Vector = std::array<float, 3>;

Words words(const Vector& v) { return floats(v[0], v[1], v[2]); }
Vector vector(Random& random) { return {random.between(-2, 2), random.between(-2, 2), random.between(-2, 2)}; }
float dot(const Vector& x, const Vector& y) { return x[0] * y[0] + x[1] * y[1] + x[2] * y[2]; }

Probe vectors(const char* result, const char* expression, std::uint32_t glsl) {
  return {"vec3 x; vec3 y; vec3 z; float eta;", result, expression, spv::OpExtInst, glsl};
}

/// Single precision's own result, which errs itself, a neighbour, and one with a small error in a component.
void check(const Probe& probe, const std::vector<Words>& operands, const Vector& right) {
  Vector above = right, below = right, far = right;
  above[2] = moved(right[2], 1);
  below[2] = moved(right[2], -1);
  far[2] += 1e-4f;
  CHECK((is_within(probe(operands, words(right), words(above))) ||
         is_within(probe(operands, words(right), words(below)))));
  CHECK(blames(probe(operands, words(right), words(far)), WrongDevice::b));
}

}  // namespace

TEST_CASE("Functions of vectors inherit from their formulas") {
  Random random;
  const Probe length = vectors("float", "length(x)", GLSLstd450Length);
  const Probe distance = vectors("float", "distance(x, y)", GLSLstd450Distance);
  const Probe cross = vectors("vec3", "cross(x, y)", GLSLstd450Cross);
  const Probe normalize = vectors("vec3", "normalize(x)", GLSLstd450Normalize);
  const Probe reflect = vectors("vec3", "reflect(x, y)", GLSLstd450Reflect);
  const Probe refract = vectors("vec3", "refract(x, y, eta)", GLSLstd450Refract);
  for (int i = 0; i < 30; ++i) {
    const Vector x = vector(random), y = vector(random), d = {x[0] - y[0], x[1] - y[1], x[2] - y[2]};
    const float size = std::sqrt(dot(x, x)), gap = std::sqrt(dot(d, d));
    CHECK(is_within(length({words(x)}, floats(size), floats(moved(size, 2)))));
    CHECK(blames(length({words(x)}, floats(size), floats(size * 1.00001f)), WrongDevice::b));
    CHECK(is_within(distance({words(x), words(y)}, floats(gap), floats(moved(gap, 2)))));
    CHECK(blames(distance({words(x), words(y)}, floats(gap * 1.00001f), floats(gap)), WrongDevice::a));
    check(cross, {words(x), words(y)},
          {x[1] * y[2] - y[1] * x[2], x[2] * y[0] - y[2] * x[0], x[0] * y[1] - y[0] * x[1]});
    const Vector unit = {x[0] / size, x[1] / size, x[2] / size};
    check(normalize, {words(x)}, unit);
    const float twice = 2 * dot(y, x);
    check(reflect, {words(x), words(y)}, {x[0] - twice * y[0], x[1] - twice * y[1], x[2] - twice * y[2]});
    const Vector normal = {0, 0, unit[2] > 0 ? -1.0f : 1.0f};
    const float eta = 0.7f, cosine = dot(normal, unit), k = 1 - eta * eta * (1 - cosine * cosine);
    const float along = eta * cosine + std::sqrt(k);
    check(refract, {words(unit), words(normal), floats(eta)},
          {eta * unit[0] - along * normal[0], eta * unit[1] - along * normal[1], eta * unit[2] - along * normal[2]});
  }
  CHECK(is_undefined(normalize({words({0, 0, 0})}, words({0, 0, 0}), words({1, 0, 0}))));
  CHECK(blames(cross({words({1, 0, 0}), words({0, 1, 0})}, words({0, 0, 1}), words({0, 0, -1})), WrongDevice::b));
  const Vector grazing = {0.8f, 0, -0.6f}, up = {0, 0, 1};
  CHECK(blames(refract({words(grazing), words(up), floats(2)}, words({0, 0, 0}), words({1.6f, 0, 0})), WrongDevice::b));
}

TEST_CASE("faceforward chooses by a sign that may be open") {
  const Probe faceforward = vectors("vec3", "faceforward(x, y, z)", GLSLstd450FaceForward);
  const Words normal = words({1, 2, 3}), other = words({-1, -2, -3});
  CHECK(blames(faceforward({normal, words({1, 0, 0}), words({1, 0, 0})}, other, normal), WrongDevice::b));
  CHECK(blames(faceforward({normal, words({1, 0, 0}), words({-1, 0, 0})}, other, normal), WrongDevice::a));
  // 0.1 * 0.3 - 0.3 * 0.1, whose terms are rounded.
  CHECK(is_within(faceforward({normal, words({0.1f, 0.3f, 1e-9f}), words({0.3f, -0.1f, 1e-9f})}, other, normal)));
}

TEST_CASE("Determinants and inverses are held against their cofactors") {
  const Probe determinant("mat3 m;", "float", "determinant(m)", spv::OpExtInst, GLSLstd450Determinant);
  const Probe inverse("mat2 m;", "mat2", "inverse(m)", spv::OpExtInst, GLSLstd450MatrixInverse);
  const Words m = floats(2, 0, 1, 1, 3, 0, 0, 1, 4);
  CHECK(determinant({m}, floats(1), floats(2)).expected->words == floats(25));
  CHECK(blames(determinant({m}, floats(25), floats(moved(25.0f, 100))), WrongDevice::b));
  // Columns (1, 2) and (3, 5): the determinant is -1.
  CHECK(blames(inverse({floats(1, 2, 3, 5)}, floats(-5, 2, 3, -1), floats(-5, 3, 2, -1)), WrongDevice::b));
  CHECK(is_within(inverse({floats(1, 2, 3, 5)}, floats(-5, 2, 3, -1), floats(moved(-5.0f, 1), 2, 3, -1))));
  CHECK(is_undefined(inverse({floats(1, 2, 2, 4)}, floats(0, 0, 0, 0), floats(1, 0, 0, 0))));
  const Probe large("mat4 m;", "mat4", "inverse(m)", spv::OpExtInst, GLSLstd450MatrixInverse);
  const Words scale = floats(2, 0, 0, 0, 0, 4, 0, 0, 0, 0, 8, 0, 1, 2, 3, 1);
  const Words right = floats(0.5, 0, 0, 0, 0, 0.25, 0, 0, 0, 0, 0.125, 0, -0.5, -0.5, -0.375, 1);
  Words wrong = right;
  wrong[12] = floats(0.5)[0];
  CHECK(blames(large({scale}, right, wrong), WrongDevice::b));
  CHECK(large({scale}, right, wrong).expected->words == right);
}

TEST_CASE("Packed fields are rounded either way") {
  const auto pack = [](const char* type, const char* expression, std::uint32_t glsl) {
    return Probe(std::string(type) + " v;", "uint", expression, spv::OpExtInst, glsl);
  };
  const auto unpack = [](const char* type, const char* expression, std::uint32_t glsl) {
    return Probe("uint x;", type, expression, spv::OpExtInst, glsl);
  };
  const Probe unorm = pack("vec4", "packUnorm4x8(v)", GLSLstd450PackUnorm4x8);
  CHECK(blames(unorm({floats(0, 1, 2, -1)}, {0x00ffff00u}, {0x00fffe00u}), WrongDevice::b));
  CHECK(is_within(unorm({floats(0.5, 0, 0, 0)}, {127}, {128})));
  CHECK(is_undefined(unorm({floats(NAN, 0, 0, 0)}, {0}, {255})));
  const Probe snorm = pack("vec2", "packSnorm2x16(v)", GLSLstd450PackSnorm2x16);
  CHECK(blames(snorm({floats(-1, 1)}, {0x7fff8001u}, {0x7fff8000u}), WrongDevice::b));
  const Probe halves = pack("vec2", "packHalf2x16(v)", GLSLstd450PackHalf2x16);
  CHECK(blames(halves({floats(1, -2)}, {0xc0003c00u}, {0x3c00c000u}), WrongDevice::b));
  CHECK(is_within(halves({floats(1.0001, 0)}, {0x3c00}, {0x3c01})));
  CHECK(blames(halves({floats(1.0001, 0)}, {0x3c00}, {0x3c02}), WrongDevice::b));
  CHECK(is_within(halves({floats(0x1p-20f, 0)}, {0x0010}, {0x0000})));
  const Probe from_halves = unpack("vec2", "unpackHalf2x16(x)", GLSLstd450UnpackHalf2x16);
  CHECK(blames(from_halves({{0xc0003c00u}}, floats(1, -2), floats(-2, 1)), WrongDevice::b));
  CHECK(is_within(from_halves({{0x0010}}, floats(0x1p-20f, 0), floats(0, 0))));
  const Probe from_unorm = unpack("vec4", "unpackUnorm4x8(x)", GLSLstd450UnpackUnorm4x8);
  const float third = 85.0f / 255;
  CHECK(is_within(from_unorm({{85}}, floats(third, 0, 0, 0), floats(moved(third, 1), 0, 0, 0))));
  CHECK(blames(from_unorm({{85}}, floats(third, 0, 0, 0), floats(moved(third, 8), 0, 0, 0)), WrongDevice::b));
  const Probe from_snorm = unpack("vec4", "unpackSnorm4x8(x)", GLSLstd450UnpackSnorm4x8);
  CHECK(blames(from_snorm({{0x80}}, floats(-1, 0, 0, 0), floats(-128.0f / 127, 0, 0, 0)), WrongDevice::b));
  const Probe double_bits("uvec2 x;", "double", "packDouble2x32(x)", spv::OpExtInst, GLSLstd450PackDouble2x32);
  CHECK(blames(double_bits({wide(1.5)}, wide(1.5), {0x3ff80000u, 0}), WrongDevice::b));
}
