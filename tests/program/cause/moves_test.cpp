#include <doctest/doctest.h>

#include <bit>
#include <cmath>

#include "rhi/glsl/compile.hpp"
#include "tests/program/cause/probe.hpp"

using namespace tandem::program;
using namespace tandem::program::testing;

TEST_CASE("Parts of composites move without a change") {
  const Probe extract("vec4 v;", "float", "(v + v).z", spv::OpCompositeExtract);
  CHECK(blames(extract({floats(1, 2, 3, 4)}, floats(3), floats(2)), WrongDevice::b));
  const Probe construct("float x; vec2 y;", "vec3", "vec3(x, y * 2)", spv::OpCompositeConstruct);
  CHECK(blames(construct({floats(1), floats(2), floats(3)}, floats(1, 2, 3), floats(1, 3, 2)), WrongDevice::b));
  const Probe shuffle("vec4 v;", "vec2", "(v + v).wy", spv::OpVectorShuffle);
  CHECK(blames(shuffle({floats(1, 2, 3, 4), floats(1, 2, 3, 4)}, floats(4, 2), floats(2, 4)), WrongDevice::b));
  const Probe transpose("mat2x3 m;", "mat3x2", "transpose(m)", spv::OpTranspose);
  CHECK(blames(transpose({floats(1, 2, 3, 4, 5, 6)}, floats(1, 4, 2, 5, 3, 6), floats(1, 2, 3, 4, 5, 6)),
               WrongDevice::b));
  const Probe column("mat2x3 m;", "vec3", "(m * 2)[1]", spv::OpCompositeExtract);
  CHECK(blames(column({floats(1, 2, 3, 4, 5, 6)}, floats(4, 5, 6), floats(1, 2, 3)), WrongDevice::b));
}

TEST_CASE("Moves keep denormals, and not the sign of zero") {
  const Probe extract("vec4 v;", "float", "(v + v).z", spv::OpCompositeExtract);
  CHECK(blames(extract({floats(1, 2, 0x1p-130f, 4)}, floats(0x1p-130f), floats(0)), WrongDevice::b));
  CHECK(is_within(extract({floats(1, 2, -0.0, 4)}, floats(-0.0), floats(0))));
  CHECK(is_within(extract({floats(1, 2, NAN, 4)}, floats(NAN), floats(1))));
}

TEST_CASE("A dynamic index out of range is undefined") {
  const Probe extract("vec4 v; int i;", "float", "(v + v)[i]", spv::OpVectorExtractDynamic);
  CHECK(blames(extract({floats(1, 2, 3, 4), {1}}, floats(2), floats(3)), WrongDevice::b));
  CHECK(is_undefined(extract({floats(1, 2, 3, 4), {4}}, floats(2), floats(3))));
  CHECK(is_undefined(extract({floats(1, 2, 3, 4), {~0u}}, floats(2), floats(3))));
}

TEST_CASE("A selection takes one of two") {
  const Probe select("float x; float y; uint c;", "float", "mix(x, y, c == 1)", spv::OpSelect);
  CHECK(blames(select({{1}, floats(5), floats(6)}, floats(5), floats(6)), WrongDevice::b));
  CHECK(blames(select({{0}, floats(5), floats(6)}, floats(5), floats(6)), WrongDevice::a));
  const Probe vectors("ivec2 x; ivec2 y; uvec2 c;", "ivec2", "mix(x, y, equal(c, uvec2(1)))", spv::OpSelect);
  CHECK(blames(vectors({{1, 0}, {5, 6}, {7, 8}}, {5, 8}, {7, 6}), WrongDevice::b));
}

TEST_CASE("A bitcast is exact") {
  const Probe bits("float x;", "uint", "floatBitsToUint(x)", spv::OpBitcast);
  CHECK(blames(bits({floats(1)}, floats(1), floats(2)), WrongDevice::b));
  CHECK(is_within(bits({floats(NAN)}, {0x7fc00000u}, {0x7fc00001u})));
  const Probe halves("f16vec2 x;", "uint", "packFloat2x16(x)", spv::OpBitcast);
  CHECK(halves({floats(1, -2)}, {0}, {1}).expected->words == Words{0xc0003c00u});
  const Probe whole("uvec2 x;", "uint64_t", "packUint2x32(x)", spv::OpBitcast);
  CHECK(blames(whole({{1, 2}}, {1, 2}, {2, 1}), WrongDevice::b));
}

TEST_CASE("An operand that is not recorded leaves the device unknown") {
  const Probe extract("vec4 v;", "float", "(v + v).z", spv::OpCompositeExtract);
  const auto type = *components_of(extract.module(), extract.instruction().type);
  const std::vector<std::optional<RecordedWords>> nothing(1);
  const Judgement judgement =
      judge(extract.module(), extract.instruction(), nothing, {type, floats(1)}, {type, floats(2)});
  CHECK(blames(judgement, WrongDevice::unknown));
  const Probe load("vec4 v;", "float", "(v + v).z", spv::OpLoad);
  const auto vector = *components_of(load.module(), load.instruction().type);
  CHECK(blames(
      judge(load.module(), load.instruction(), nothing, {vector, floats(1, 2, 3, 4)}, {vector, floats(1, 2, 3, 5)}),
      WrongDevice::unknown));
}

TEST_CASE("What an instruction makes of OpUndef is undefined") {
  Probe sum("float x; float y;", "float", "x + y", spv::OpFAdd);
  Module module = sum.module();
  const Instruction& load = definition(module, sum.instruction().words[4]);
  const std::size_t place = module.definitions.at(load.result);
  module.instructions[place].op = spv::OpUndef;
  const auto type = *components_of(module, sum.instruction().type);
  const std::vector<std::optional<RecordedWords>> operands = {RecordedWords{type, floats(1)}, std::nullopt};
  CHECK(is_undefined(judge(module, sum.instruction(), operands, {type, floats(1)}, {type, floats(2)})));
}

TEST_CASE("OpPhi has the value of one predecessor") {
  const Probe bits("float x; float y; uint c;", "bool", "c == 1 && x < y", spv::OpPhi);
  CHECK(blames(bits({{0}, {0}}, {0}, {1}), WrongDevice::b));
  CHECK(blames(bits({{1}, {0}}, {0}, {1}), WrongDevice::unknown));
  CHECK(blames(bits({{1}, {1}}, {0}, {1}), WrongDevice::a));
}

TEST_CASE("Conversions are exact or correctly rounded") {
  const Probe to_int("float x;", "int", "int(x)", spv::OpConvertFToS);
  const Probe to_uint("float x;", "uint", "uint(x)", spv::OpConvertFToU);
  CHECK(blames(to_int({floats(-2.75)}, {static_cast<std::uint32_t>(-2)}, {static_cast<std::uint32_t>(-3)}),
               WrongDevice::b));
  CHECK(blames(to_uint({floats(3e9)}, {3000000000u}, {0x7fffffffu}), WrongDevice::b));
  CHECK(blames(to_uint({floats(-0.5)}, {0}, {1}), WrongDevice::b));
  CHECK(is_undefined(to_int({floats(3e9)}, {0x7fffffffu}, {0x80000000u})));
  CHECK(is_undefined(to_int({floats(NAN)}, {0}, {0x80000000u})));
  CHECK(is_undefined(to_uint({floats(-1)}, {0}, {~0u})));
  CHECK(blames(to_int({floats(-0x1p31f)}, {0x80000000u}, {0}), WrongDevice::b));

  const Probe from_int("int x;", "float", "float(x)", spv::OpConvertSToF);
  const Probe from_uint("uint x;", "float", "float(x)", spv::OpConvertUToF);
  CHECK(blames(from_int({{~0u}}, floats(-1), floats(4294967296.0f)), WrongDevice::b));
  CHECK(blames(from_uint({{~0u}}, floats(-1), floats(4294967296.0f)), WrongDevice::a));
  CHECK(is_within(from_uint({{~0u}}, floats(moved(4294967296.0f, -1)), floats(4294967296.0f))));
  CHECK(blames(from_int({{16777215}}, floats(16777215), floats(16777214)), WrongDevice::b));

  const Probe narrow("double x;", "float", "float(x)", spv::OpFConvert);
  CHECK(is_within(narrow({wide(0.1)}, floats(0.1f), floats(moved(0.1f, -1)))));
  CHECK(blames(narrow({wide(0.1)}, floats(0.1f), floats(moved(0.1f, 1))), WrongDevice::b));
  CHECK(blames(narrow({wide(0.5)}, floats(0.5f), floats(moved(0.5f, 1))), WrongDevice::b));
  const Probe widen("float x;", "double", "double(x)", spv::OpFConvert);
  CHECK(blames(widen({floats(0.1f)}, wide(static_cast<double>(0.1f)), wide(0.1)), WrongDevice::b));
  const Probe half("float x;", "float16_t", "float16_t(x)", spv::OpFConvert);
  CHECK(is_within(half({floats(1.0001)}, floats(1), floats(1 + 0x1p-10f))));
  CHECK(blames(half({floats(1.0001)}, floats(1), floats(1 + 0x1p-9f)), WrongDevice::b));

  const Probe sign_extend("int8_t x;", "int", "int(x)", spv::OpSConvert);
  CHECK(blames(sign_extend({{0x80}}, {0xffffff80u}, {0x80}), WrongDevice::b));
  const Probe zero_extend("uint16_t x;", "uint", "uint(x)", spv::OpUConvert);
  CHECK(blames(zero_extend({{0x8000}}, {0xffff8000u}, {0x8000}), WrongDevice::a));
  const Probe truncate("uint x;", "uint8_t", "uint8_t(x)", spv::OpUConvert);
  CHECK(blames(truncate({{0x1234}}, {0x34}, {0x12}), WrongDevice::b));

  const Probe quantize = Probe("float x;", "float", "-x", spv::OpFNegate).with(spv::OpQuantizeToF16);
  CHECK(is_within(quantize({floats(1.0001)}, floats(1), floats(1 + 0x1p-10f))));
  CHECK(blames(quantize({floats(1.0001)}, floats(1), floats(1.0001)), WrongDevice::b));
  CHECK(is_within(quantize({floats(0x1p-20f)}, floats(0), floats(0x1p-20f))));
}
