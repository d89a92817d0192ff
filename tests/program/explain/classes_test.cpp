// Differences that correct devices may have are no mismatch: a device is made to differ in such a way.

#include <doctest/doctest.h>

#include <cstdint>
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
