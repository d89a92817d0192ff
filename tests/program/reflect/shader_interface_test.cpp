#include "program/reflect/shader_interface.hpp"

#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "rhi/error.hpp"
#include "rhi/glsl/compile.hpp"

using namespace tandem;
using namespace tandem::program;

namespace {

ShaderInterface interface_of_compute(const std::string& text) {
  return interface_of(
      {.name = "shader",
       .spirv = glsl::compile("#version 460\n" + text, rhi::ShaderStage::compute, "shader", {.debug_info = true})});
}

const ShaderInterface& example() {
  static const ShaderInterface result = interface_of_compute(R"(
    #extension GL_EXT_shader_explicit_arithmetic_types : require
    #extension GL_EXT_scalar_block_layout : require
    #extension GL_EXT_buffer_reference : require
    struct Particle { vec3 position; float mass; };
    layout(buffer_reference) buffer List { uint next; };
    layout(set = 1, binding = 2) buffer Particles { uint count; Particle particles[]; } all;
    layout(set = 0, binding = 3, std140) uniform Settings { float weights[3]; layout(row_major) mat2x3 rotation; };
    layout(set = 0, binding = 1, scalar) buffer Out { f16vec3 results[]; };
    layout(push_constant) uniform Push { vec2 size; uint seed; List list; };
    layout(constant_id = 5) const uint steps = 8;
    layout(constant_id = 6) const double weight = 2.25;
    layout(constant_id = 7) const bool on = true;
    void main() {
      results[0] = f16vec3(all.particles[0].position * weights[1] * (on ? float(weight) : 1));
      results[1] = f16vec3(rotation * size) + float16_t(seed + steps + all.count + list.next);
    }
  )");
  return result;
}

std::vector<std::string> paths_of(const ValueType& type, std::uint64_t bytes) {
  std::vector<std::string> paths;
  for (std::uint64_t i = 0; i < scalar_count(type, bytes); ++i)
    paths.push_back(path_of(type, bytes, i) + "@" + std::to_string(place_of(type, bytes, i).offset));
  return paths;
}

TEST_CASE("blocks have the members, offsets and strides of their layouts") {
  const std::vector<BlockLayout>& blocks = example().blocks;
  REQUIRE(blocks.size() == 3);
  CHECK(blocks[0].block == "Out");
  CHECK(blocks[0].instance.empty());
  CHECK(describe(blocks[0].type.members[0].type) == "f16vec3[]");
  CHECK(blocks[0].type.members[0].type.stride == 6);
  CHECK(blocks[1].binding == 3);
  CHECK(paths_of(blocks[1].type, 96) == std::vector<std::string>{"weights[0]@0", "weights[1]@16", "weights[2]@32",
                                                                 "rotation[0][0]@48", "rotation[0][1]@64",
                                                                 "rotation[0][2]@80", "rotation[1][0]@52",
                                                                 "rotation[1][1]@68", "rotation[1][2]@84"});
  CHECK(blocks[2].set == 1);
  CHECK(blocks[2].instance == "all");
  CHECK(paths_of(blocks[2].type, 48) ==
        std::vector<std::string>{"count@0", "particles[0].position.x@16", "particles[0].position.y@20",
                                 "particles[0].position.z@24", "particles[0].mass@28", "particles[1].position.x@32",
                                 "particles[1].position.y@36", "particles[1].position.z@40", "particles[1].mass@44"});
  CHECK(describe(blocks[2].type.members[1].type) == "Particle[]");
}

TEST_CASE("push constants have their members, a buffer reference as a number; constants are listed") {
  REQUIRE(example().push_constants.has_value());
  CHECK(paths_of(*example().push_constants, 24) ==
        std::vector<std::string>{"size.x@0", "size.y@4", "seed@8", "list@16"});
  REQUIRE(example().reflection.specialization_constants.size() == 3);
  CHECK(example().reflection.specialization_constants[0].name == "steps");
  const std::vector<ConstantLayout>& constants = example().constants;
  REQUIRE(constants.size() == 3);
  CHECK(constants[0].id == 5);
  CHECK(constants[0].type == ScalarType::uint32);
  CHECK(constants[0].default_value == 8);
  CHECK(constants[1].type == ScalarType::float64);
  CHECK(constants[1].default_value == 0x4002000000000000);
  CHECK(constants[2].is_bool);
  CHECK(constants[2].default_value == 1);
  CHECK_FALSE(example().shader_record.has_value());
}

TEST_CASE("a binding is called by its block, its instance or its only member") {
  const rhi::ShaderBinding& particles = example().reflection.bindings.back();
  CHECK(particles.set == 1);
  CHECK(is_called(example(), particles, "Particles"));
  CHECK(is_called(example(), particles, "all"));
  CHECK_FALSE(is_called(example(), particles, "particles"));
  CHECK(is_called(example(), example().reflection.bindings.front(), "results"));
  CHECK_FALSE(is_called(example(), example().reflection.bindings.front(), "all"));
  CHECK(block_at(example(), 1, 2)->block == "Particles");
  CHECK(block_at(example(), 1, 3) == nullptr);
  CHECK(describe(contents_type(block_at(example(), 0, 1)->type)) == "f16vec3[]");
  CHECK(describe(contents_type(block_at(example(), 1, 2)->type)) == "Particles");
}

TEST_CASE("a shader record has its layout, and an array the default length of its constant") {
  const Shader shader{.name = "hit",
                      .stage = rhi::ShaderStage::closest_hit,
                      .spirv = glsl::compile(R"(#version 460
    #extension GL_EXT_ray_tracing : require
    layout(constant_id = 1) const int count = 3;
    layout(location = 0) rayPayloadInEXT float value;
    layout(binding = 0) buffer Values { float values[count]; };
    layout(shaderRecordEXT) buffer Record { vec3 color; float shine; };
    void main() { value = color.x * shine * values[2]; }
  )",
                                             rhi::ShaderStage::closest_hit, "hit")};
  const ShaderInterface hit = interface_of(shader);
  REQUIRE(hit.shader_record.has_value());
  CHECK(hit.shader_record->size == 16);
  CHECK(hit.shader_record->members.size() == 2);
  CHECK(hit.blocks[0].type.size == 12);
}

TEST_CASE("what is no SPIR-V is refused in the shader's name") {
  CHECK_THROWS_AS(interface_of({.name = "nonsense", .spirv = {1, 2, 3}}), rhi::Error);
}

}  // namespace
