#include <doctest/doctest.h>

#include <string>

#include "rhi/error.hpp"
#include "rhi/glsl/compile.hpp"
#include "rhi/pipeline.hpp"
#include "tests/rhi/plain_objects.hpp"

namespace {

using namespace tandem;
using rhi::BindingKind;
using rhi::ShaderStage;
using test::plain_shader;

TEST_CASE("reflection knows the ray tracing stages, their shader record and their push constants") {
  const rhi::ShaderModuleHandle shader = plain_shader(ShaderStage::closest_hit, R"(
    layout(location = 0) rayPayloadInEXT vec3 payload;
    layout(shaderRecordEXT, std430) buffer Record { vec3 color; uint more[3]; } record;
    layout(push_constant) uniform Constants { vec4 tint; float scale; };
    void main() { payload = record.color * tint.rgb * scale * float(record.more[2]); }
  )");
  const rhi::ShaderReflection& reflection = shader->reflection();
  CHECK(reflection.stage == ShaderStage::closest_hit);
  CHECK(reflection.shader_record_size == 24);
  CHECK(reflection.push_constant_size == 20);
  CHECK(reflection.bindings.empty());
}

TEST_CASE("reflection tells the dimension, format and access of storage images") {
  const rhi::ShaderModuleHandle shader = plain_shader(ShaderStage::ray_generation, R"(
    layout(set = 1, binding = 4, rgba32f) uniform writeonly image2D picture;
    layout(set = 1, binding = 2, r32ui) uniform readonly uimage3D volume;
    layout(set = 0, binding = 7, rgba8) uniform image2DArray layers[2];
    layout(set = 0, binding = 1) uniform writeonly image1D line;
    void main() {
      vec4 texel = imageLoad(layers[1], ivec3(0)) + vec4(imageLoad(volume, ivec3(0)));
      imageStore(picture, ivec2(gl_LaunchIDEXT.xy), texel);
      imageStore(line, 0, texel);
    }
  )");
  const std::vector<rhi::ShaderBinding>& bindings = shader->reflection().bindings;
  REQUIRE(bindings.size() == 4);
  for (const rhi::ShaderBinding& binding : bindings) CHECK(binding.kind == BindingKind::storage_image);
  CHECK(bindings[0].dimension == rhi::TextureDimension::d1);
  CHECK_FALSE(bindings[0].format.has_value());
  CHECK(bindings[1].dimension == rhi::TextureDimension::d2_array);
  CHECK(bindings[1].format == rhi::TextureFormat::rgba8_unorm);
  CHECK(bindings[1].count == 2);
  CHECK(bindings[1].writable);
  CHECK(bindings[2].dimension == rhi::TextureDimension::d3);
  CHECK(bindings[2].format == rhi::TextureFormat::r32_uint);
  CHECK_FALSE(bindings[2].writable);
  CHECK(bindings[3].dimension == rhi::TextureDimension::d2);
  CHECK(bindings[3].format == rhi::TextureFormat::rgba32_float);
}

TEST_CASE("the interface of several shaders is their union") {
  const rhi::ShaderModuleHandle shaders[] = {plain_shader(ShaderStage::miss, R"(
        layout(set = 0, binding = 3) readonly buffer Values { float values[]; };
        layout(push_constant) uniform Constants { float scale; };
        layout(location = 0) rayPayloadInEXT float payload;
        void main() { payload = values[0] * scale; }
      )"),
                                             plain_shader(ShaderStage::ray_generation, R"(
        layout(set = 0, binding = 3) buffer Values { float values[]; };
        layout(set = 0, binding = 1) uniform accelerationStructureEXT scene;
        layout(push_constant) uniform Constants { float scale; float other; };
        layout(location = 0) rayPayloadEXT float payload;
        void main() {
          traceRayEXT(scene, 0u, 0xff, 0, 0, 0, vec3(0), 0.0, vec3(1), other, 0);
          values[1] = payload;
        }
      )")};
  const rhi::PipelineInterface interface = rhi::combined_interface(shaders, "both");
  REQUIRE(interface.bindings.size() == 2);
  CHECK(interface.bindings[0].binding == 1);
  CHECK(interface.bindings[0].kind == BindingKind::acceleration_structure);
  CHECK(interface.bindings[1].binding == 3);
  CHECK(interface.bindings[1].writable);
  CHECK(interface.push_constant_size == 8);
}

TEST_CASE("shaders that declare a binding differently do not go together") {
  const rhi::ShaderModuleHandle shaders[] = {plain_shader(ShaderStage::callable, R"(
                                               layout(binding = 3) buffer Values { float values[]; };
                                               void main() { values[0] = 1.0; }
                                             )"),
                                             plain_shader(ShaderStage::callable, R"(
                                               layout(binding = 3) uniform Block { float value; };
                                               layout(location = 0) callableDataInEXT float data;
                                               void main() { data = value; }
                                             )")};
  CHECK_THROWS_WITH_AS(rhi::combined_interface(shaders, "odd"), doctest::Contains("set 0 binding 3"), rhi::Error);
}

}  // namespace
