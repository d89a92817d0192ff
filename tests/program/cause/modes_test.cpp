#include <doctest/doctest.h>

#include <cmath>

#include <spirv_cross/GLSL.std.450.h>

#include "tests/program/cause/probe.hpp"

using namespace tandem::program;
using namespace tandem::program::testing;

namespace {

Probe scalars(const char* expression, spv::Op op, const Extras& extras = {}) {
  return {"float x; float y; float z;", "float", expression, op, 0, extras};
}

Extras mode(spv::ExecutionMode mode) { return {.modes = {{mode, 32}}}; }

/// Values by id: those of the loads of the members x, y and z.
ValueLookup members(const Probe& probe, std::vector<float> values) {
  return [&probe, values](std::uint32_t id) -> std::optional<RecordedWords> {
    const Instruction& load = definition(probe.module(), id);
    if (load.op != spv::OpLoad) return std::nullopt;
    const Instruction& chain = definition(probe.module(), load.words[3]);
    const Instruction& index = definition(probe.module(), chain.words[4]);
    return RecordedWords{*components_of(probe.module(), load.type), floats(values.at(index.words[3]))};
  };
}

}  // namespace

TEST_CASE("Denormals may be flushed unless DenormPreserve says otherwise") {
  const float tiny = 0x1p-130f;
  const Probe sum = scalars("x + y", spv::OpFAdd);
  const std::vector<Words> denormals = {floats(tiny), floats(tiny)};
  const Judgement flushed = sum(denormals, floats(2 * tiny), floats(0));
  CHECK(is_within(flushed));
  CHECK(flushed.reason.find("denormal") != std::string::npos);
  CHECK(blames(sum(denormals, floats(2 * tiny), floats(tiny)), WrongDevice::b));
  // A normal result of denormal operands.
  CHECK(is_within(sum({floats(0x1p-126f), floats(tiny)}, floats(0x1p-126f + tiny), floats(0x1p-126f))));
  const Probe product = scalars("x * y", spv::OpFMul);
  CHECK(is_within(product({floats(tiny), floats(0x1p100f)}, floats(0x1p-30f), floats(0))));
  CHECK(blames(product({floats(tiny), floats(0x1p100f)}, floats(0x1p-30f), floats(0x1p-31f)), WrongDevice::b));

  const Probe preserved = scalars("x + y", spv::OpFAdd, mode(spv::ExecutionModeDenormPreserve));
  CHECK(blames(preserved(denormals, floats(2 * tiny), floats(0)), WrongDevice::b));
  const Probe must_flush = scalars("x + y", spv::OpFAdd, mode(spv::ExecutionModeDenormFlushToZero));
  CHECK(blames(must_flush(denormals, floats(2 * tiny), floats(0)), WrongDevice::a));
}

TEST_CASE("A rounding mode leaves one result") {
  // 1 + 2^-24 lies between 1 and the next float; 1 + 3 * 2^-25 nearer to the latter.
  const float next = moved(1.0f, 1);
  const std::vector<Words> operands = {floats(1), floats(3 * 0x1p-25f)};
  CHECK(is_within(scalars("x + y", spv::OpFAdd)(operands, floats(1), floats(next))));
  const Probe nearest = scalars("x + y", spv::OpFAdd, mode(spv::ExecutionModeRoundingModeRTE));
  CHECK(blames(nearest(operands, floats(1), floats(next)), WrongDevice::a));
  CHECK(blames(nearest({floats(1), floats(0x1p-24f)}, floats(1), floats(next)), WrongDevice::b));
  const Probe to_zero = scalars("x + y", spv::OpFAdd, mode(spv::ExecutionModeRoundingModeRTZ));
  CHECK(blames(to_zero(operands, floats(1), floats(next)), WrongDevice::b));
}

TEST_CASE("NaN, infinity and the sign of zero count with SignedZeroInfNanPreserve only") {
  const Probe plain = scalars("x * y", spv::OpFMul);
  const Probe kept = scalars("x * y", spv::OpFMul, mode(spv::ExecutionModeSignedZeroInfNanPreserve));
  const std::vector<Words> zeros = {floats(-0.0), floats(1)}, infinite = {floats(INFINITY), floats(2)};
  const std::vector<Words> overflow = {floats(0x1p100f), floats(0x1p100f)}, nan = {floats(INFINITY), floats(0)};
  CHECK(is_within(plain(zeros, floats(-0.0), floats(0.0))));
  CHECK(blames(kept(zeros, floats(-0.0), floats(0.0)), WrongDevice::b));
  CHECK(is_within(plain(infinite, floats(INFINITY), floats(5))));
  CHECK(blames(kept(infinite, floats(INFINITY), floats(5)), WrongDevice::b));
  CHECK(is_within(plain(nan, floats(NAN), floats(0))));
  CHECK(blames(kept(nan, floats(NAN), floats(0)), WrongDevice::b));
  CHECK(is_within(plain(overflow, floats(INFINITY), floats(7))));
  // Without a rounding mode, the largest number is as good as infinity.
  CHECK(is_within(kept(overflow, floats(INFINITY), floats(0x1.fffffep127f))));
  CHECK(blames(kept(overflow, floats(INFINITY), floats(7)), WrongDevice::b));
  // The bits of a NaN never count; NaN out of numbers is wrong.
  CHECK(is_within(kept(nan, {0x7fc00000u}, {0xffc00001u})));
  CHECK(blames(plain({floats(2), floats(3)}, floats(6), floats(NAN)), WrongDevice::b));
}

TEST_CASE("RelaxedPrecision means 16 bits") {
  const Extras relaxed{.modes = {}, .decorations = {spv::DecorationRelaxedPrecision}};
  const Probe product = scalars("x * y", spv::OpFMul, relaxed);
  CHECK(is_within(product({floats(1.1), floats(1.3)}, floats(1.1f * 1.3f), floats(1.4297))));
  CHECK(blames(product({floats(1.1), floats(1.3)}, floats(1.1f * 1.3f), floats(1.46)), WrongDevice::b));
  CHECK(is_within(product({floats(300), floats(300)}, floats(90000), floats(INFINITY))));
  // The operands are rounded before they cancel.
  const Probe difference = scalars("x - y", spv::OpFSub, relaxed);
  CHECK(is_within(difference({floats(1.0003), floats(1)}, floats(1.0003f - 1.0f), floats(0))));
  const Probe sum("int x; int y;", "int", "x + y", spv::OpIAdd, 0, relaxed);
  CHECK(is_within(sum({{30000}, {30000}}, {60000}, {static_cast<std::uint32_t>(60000 - 65536)})));
  CHECK(blames(sum({{3}, {4}}, {7}, {8}), WrongDevice::b));
}

TEST_CASE("A multiplication and an addition may be fused unless NoContraction forbids it") {
  const float x = 1 + 0x1p-12f, y = 1 + 0x1p-12f, z = -1 - 0x1p-11f;
  const float product = x * y, separate = product + z, fused = std::fma(x, y, z);
  REQUIRE(separate != fused);
  const std::vector<Words> operands = {floats(product), floats(z)};
  const Probe sum = scalars("x * y + z", spv::OpFAdd);
  const Judgement judgement = sum(operands, floats(separate), floats(fused), members(sum, {x, y, z}));
  CHECK(is_within(judgement));
  CHECK(judgement.reason.find("fused") != std::string::npos);
  CHECK(is_within(sum(operands, floats(separate), floats(fused))));  // by the product's rounding error
  CHECK(blames(sum(operands, floats(separate), floats(fused * 4), members(sum, {x, y, z})), WrongDevice::b));
  const Probe precise = scalars("x * y + z", spv::OpFAdd, {.modes = {}, .decorations = {spv::DecorationNoContraction}});
  CHECK(blames(precise(operands, floats(separate), floats(fused), members(precise, {x, y, z})), WrongDevice::b));
  const Probe plain = scalars("x + z", spv::OpFAdd);
  CHECK(blames(plain(operands, floats(separate), floats(fused), members(plain, {x, y, z})), WrongDevice::b));
}

TEST_CASE("A product is fused through vectors, negations and subtractions") {
  const Probe through("vec2 x; vec2 y; float z;", "float", "z - (x * y).y", spv::OpFSub);
  const float x = 1 + 0x1p-12f, z = 1 + 0x1p-11f, product = x * x;
  const ValueLookup lookup = [&](std::uint32_t id) -> std::optional<RecordedWords> {
    const Instruction& load = definition(through.module(), id);
    if (load.op != spv::OpLoad) return std::nullopt;
    return RecordedWords{*components_of(through.module(), load.type), floats(7, x)};
  };
  CHECK(is_within(through({floats(z), floats(product)}, floats(z - product), floats(std::fma(-x, x, z)), lookup)));
}

TEST_CASE("What is equal in real numbers may be rearranged") {
  const Probe difference = scalars("(x + y) - x", spv::OpFSub);
  const float x = 1e8f, y = 1.5f;
  CHECK(is_within(
      difference({floats(x + y), floats(x)}, floats((x + y) - x), floats(y), members(difference, {x, y, 0}))));
  CHECK(blames(difference({floats(x + y), floats(x)}, floats((x + y) - x), floats(3), members(difference, {x, y, 0})),
               WrongDevice::b));
}
