// Differences that correct devices may have are no mismatch: a device is made to differ in such a way.

#include <doctest/doctest.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "program/explain/explanation.hpp"
#include "rhi/glsl/compile.hpp"
#include "tests/faults/faulty_device.hpp"
#include "tests/faults/shader_edits.hpp"
#include "tests/support/device_test.hpp"

using namespace tandem;
using namespace tandem::test;

namespace {

program::Job job_of(const std::string& source) {
  program::Job job;
  job.shaders = {{.name = "shader",
                  .spirv = glsl::compile("#version 460\n#extension GL_EXT_ray_query : require\n" + source,
                                         rhi::ShaderStage::compute, "shader", {.debug_info = true})}};
  job.buffers = {{.name = "result", .initial = std::vector<std::byte>(64)}};
  program::Pipeline pipeline;
  pipeline.name = "shader";
  pipeline.stages = program::ComputeStages{};
  pipeline.bindings = {{.set = 0, .binding = 0, .resource = program::BufferUse{.buffer = 0}}};
  job.pipelines = {pipeline};
  job.commands = {program::Dispatch{}};
  return job;
}

/// Two triangles that share the edge from (0, 1) to (1, 0).
void add_square(program::Job& job) {
  job.bottom_levels = {{.name = "square",
                        .geometries = {program::Triangles{.positions = {{0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}},
                                                          .indices = {0, 1, 2, 2, 1, 3}}}}};
  job.top_levels = {{.name = "scene", .instances = {{.bottom_level = 0}}}};
  job.pipelines[0].bindings.push_back({.set = 0, .binding = 1, .resource = program::TopLevelUse{0}});
}

/// The device with one lane on the CPU, and a shader that is edited.
rhi::DeviceHandle edited(const std::string& device_name, ShaderEdit edit) {
  DeviceEdits edits;
  edits.shader = std::move(edit);
  return faulty_device(test::device(device_name == "cpu" ? "cpu-scalar" : device_name), std::move(edits));
}

program::Explanation explained(const program::Job& job, rhi::Device& b) {
  program::ExplainOptions options;
  options.exact = test::device("cpu-exact").get();
  return program::explain(*test::device("cpu-scalar"), b, job, options);
}

/// A ray along +z from here.
std::string ray_from(const std::string& x, const std::string& y) {
  return R"(
    layout(set = 0, binding = 0) buffer Result { int primitive; int type; };
    layout(set = 0, binding = 1) uniform accelerationStructureEXT scene;
    void main() {
      rayQueryEXT query;
      rayQueryInitializeEXT(query, scene, gl_RayFlagsOpaqueEXT, 0xff, vec3()" +
         x + ", " + y + R"(, 0), 0.0, vec3(0, 0, 1), 10.0);
      rayQueryProceedEXT(query);
      primitive = rayQueryGetIntersectionPrimitiveIndexEXT(query, true);
      type = int(rayQueryGetIntersectionTypeEXT(query, true));
    })";
}

const ShaderEdit other_primitive =
    edited_results(spv::OpRayQueryGetIntersectionPrimitiveIndexKHR, [](CodeWriter& code, std::uint32_t value) {
      const std::uint32_t type = code.module().type_of(value);
      return code.value(spv::OpISub, type, {code.module().constant(std::int32_t{1}), value});
    });

}  // namespace

TANDEM_DEVICE_TEST("of a ray through an edge that two triangles share, either may be the answer") {
  program::Job job = job_of(ray_from("0.5", "0.5"));
  add_square(job);
  const program::Explanation explanation = explained(job, *edited(device_name, other_primitive));
  REQUIRE(explanation.lockstep.sites.size() >= 1);
  CHECK(explanation.lockstep.sites[0].example.judgement.cause == program::Cause::tie);
  CHECK(program::gravest(explanation) == program::Cause::tie);
}

TANDEM_DEVICE_TEST("of a ray through the inside of a triangle, only that one") {
  program::Job job = job_of(ray_from("0.25", "0.25"));
  add_square(job);
  const program::Explanation explanation = explained(job, *edited(device_name, other_primitive));
  REQUIRE(explanation.lockstep.sites.size() == 1);
  const program::Judgement& judgement = explanation.lockstep.sites[0].example.judgement;
  CHECK(judgement.cause == program::Cause::mismatch);
  CHECK(judgement.wrong == program::WrongDevice::b);
}

TANDEM_DEVICE_TEST("a variable into which nothing was stored may hold anything") {
  const program::Job job = job_of(R"(
    layout(set = 0, binding = 0) buffer Result { uint bits; };
    void main() {
      uint nothing;
      bits = nothing;
    })");
  // Only loads of the variable: those that record load from buffers and private variables.
  const ShaderEdit edit = [](SpirvModule& module, rhi::ShaderStage) {
    bool found = false;
    module.edit_functions([&](Instruction instruction, CodeWriter& code) {
      if (instruction.opcode != spv::OpLoad || !code.module().has_name(instruction.operands.at(2), "nothing"))
        return code.put(std::move(instruction));
      found = true;
      code.put_changed(std::move(instruction), [&](std::uint32_t value) {
        return code.value(spv::OpBitwiseXor, code.module().uint_type(), {value, code.module().constant(1u)});
      });
    });
    return found;
  };
  const program::Explanation explanation = explained(job, *edited(device_name, edit));
  REQUIRE(explanation.lockstep.sites.size() == 1);
  CHECK(explanation.lockstep.sites[0].example.judgement.cause == program::Cause::undefined);
  CHECK(program::gravest(explanation) == program::Cause::undefined);
}

namespace {

/// Changes what an opcode gives where that is a float, by some ulp: counters and what records hold are integers.
ShaderEdit floats_moved(spv::Op opcode, std::int32_t ulp) {
  return edited_results(opcode, [ulp](CodeWriter& code, std::uint32_t value) {
    return code.module().type_of(value) == code.module().float_type() ? moved_by_ulp(code, value, ulp) : value;
  });
}

program::Job product(const std::string& qualifier) {
  program::Job job = job_of(R"(
    layout(set = 0, binding = 0) buffer Result { float x, y, product; };
    void main() {
      )" + qualifier + R"( float result = x * y;
      product = result;
    })");
  const std::array<float, 2> factors = {1.25f, 3.5f};
  std::memcpy(job.buffers[0].initial.data(), factors.data(), sizeof(factors));
  return job;
}

/// The one judgement where an edited device is compared with one that is not.
program::Judgement judged(const program::Job& job, rhi::Device& a, rhi::Device& b) {
  const program::Explanation explanation = program::explain(a, b, job, {});
  REQUIRE(explanation.lockstep.sites.size() == 1);
  CHECK(program::gravest(explanation) == explanation.lockstep.sites[0].example.judgement.cause);
  return explanation.lockstep.sites[0].example.judgement;
}

}  // namespace

TANDEM_DEVICE_TEST("the first device may combine a product with others, unless it is precise") {
  rhi::Device& b = *test::device("cpu-scalar");
  // Combined in the plain and the recorded form of the shader, which come first, not where instructions stand alone.
  const auto combining = [&] {
    return edited(device_name,
                  [edit = floats_moved(spv::OpFMul, 4), forms = std::make_shared<int>(0)](
                      SpirvModule& module, rhi::ShaderStage stage) { return (*forms)++ < 2 && edit(module, stage); });
  };
  CHECK(judged(product(""), *combining(), b).cause == program::Cause::within_precision);
  const program::Judgement precise = judged(product("precise"), *combining(), b);
  CHECK(precise.cause == program::Cause::mismatch);
  CHECK(precise.wrong == program::WrongDevice::a);
  // Wrong alone, too.
  const rhi::DeviceHandle wrong = edited(device_name, floats_moved(spv::OpFMul, 4));
  const program::Judgement of_a = judged(product(""), *wrong, b);
  CHECK(of_a.cause == program::Cause::mismatch);
  CHECK(of_a.wrong == program::WrongDevice::a);
  CHECK(judged(product(""), b, *wrong).wrong == program::WrongDevice::b);
}

TANDEM_DEVICE_TEST("a normalised texel may be rounded, and no more") {
  program::Job job = job_of(R"(
    layout(set = 0, binding = 0) buffer Result { vec4 texel; };
    layout(set = 0, binding = 1, rgba8) uniform readonly image2D image;
    void main() { texel = imageLoad(image, ivec2(0)); })");
  rhi::TextureDesc desc;
  desc.label = "image";
  job.images = {{.desc = desc, .initial = {std::byte{51}, std::byte{102}, std::byte{85}, std::byte{255}}}};
  job.pipelines[0].bindings.push_back({.set = 0, .binding = 1, .resource = program::ImageUse{.image = 0}});
  const auto nudged = [&](float scale) {
    return edited(device_name, edited_results(spv::OpImageRead, [scale](CodeWriter& code, std::uint32_t value) {
                    const std::uint32_t type = code.module().type_of(value);
                    return code.value(spv::OpVectorTimesScalar, type, {value, code.module().constant(scale)});
                  }));
  };
  CHECK(judged(job, *test::device("cpu-scalar"), *nudged(1 + 0x1p-22f)).cause == program::Cause::within_precision);
  CHECK(judged(job, *test::device("cpu-scalar"), *nudged(1 + 0x1p-16f)).cause == program::Cause::mismatch);
}

TANDEM_DEVICE_TEST("an index out of bounds reads anything, and one within bounds what was stored") {
  for (const std::uint32_t index : {3u, 4u}) {
    program::Job job = job_of(R"(
      layout(set = 0, binding = 0) buffer Result { uint index; float value; };
      void main() {
        float values[4] = {1.0, 2.0, 3.0, 4.0};
        values[index & 2u] = 5.0;
        value = values[index];
      })");
    std::memcpy(job.buffers[0].initial.data(), &index, sizeof(index));
    const program::Judgement judgement =
        judged(job, *test::device("cpu-scalar"), *edited(device_name, floats_moved(spv::OpLoad, 1)));
    CHECK(judgement.cause == (index == 3 ? program::Cause::mismatch : program::Cause::undefined));
  }
}

TANDEM_DEVICE_TEST("shared memory that nothing stores into holds anything") {
  const ShaderEdit edit = edited_results(spv::OpLoad, [](CodeWriter& code, std::uint32_t value) {
    const std::uint32_t type = code.module().float_type();
    if (code.module().type_of(value) != type) return value;
    return code.value(spv::OpFAdd, type, {value, code.module().constant(1.0f)});
  });
  for (const bool stored : {false, true}) {
    const program::Job job = job_of(std::string(R"(
      layout(set = 0, binding = 0) buffer Result { float value; };
      shared float memory;
      void main() {)") + (stored ? "memory = 2.0; barrier();" : "") +
                                    " value = memory; }");
    const program::Judgement judgement = judged(job, *test::device("cpu-scalar"), *edited(device_name, edit));
    CHECK(judgement.cause == (stored ? program::Cause::mismatch : program::Cause::undefined));
  }
}

TANDEM_DEVICE_TEST("candidates come in any order, and what is committed does not") {
  for (const bool committed : {false, true}) {
    // Behind the last candidate a query has none: it is asked for while there is one.
    const std::string body = committed ? "rayQueryConfirmIntersectionEXT(query); primitive = "
                                         "rayQueryGetIntersectionPrimitiveIndexEXT(query, true);"
                                       : "primitive = rayQueryGetIntersectionPrimitiveIndexEXT(query, false);";
    program::Job job = job_of(R"(
      layout(set = 0, binding = 0) buffer Result { int primitive; };
      layout(set = 0, binding = 1) uniform accelerationStructureEXT scene;
      void main() {
        rayQueryEXT query;
        rayQueryInitializeEXT(query, scene, gl_RayFlagsNoOpaqueEXT, 0xff, vec3(0.25, 0.25, 0), 0.0, vec3(0, 0, 1), 9.0);
        while (rayQueryProceedEXT(query)) {)" +
                              body + "} }");
    add_square(job);
    const program::Explanation explanation = explained(job, *edited(device_name, other_primitive));
    REQUIRE(explanation.lockstep.sites.size() == 1);
    CHECK(explanation.lockstep.sites[0].example.judgement.cause ==
          (committed ? program::Cause::mismatch : program::Cause::order));
  }
}
