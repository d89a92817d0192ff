#include <doctest/doctest.h>

#include <array>
#include <string>
#include <vector>

#include "rhi/error.hpp"
#include "rhi/validation.hpp"
#include "tests/rhi/plain_objects.hpp"

// The rules of the interface, without a device. What each backend does with them is tested where it runs.

namespace {

using namespace tandem;
using namespace tandem::test;
using rhi::BufferUsage;
using rhi::ErrorCode;
using rhi::ShaderStage;

class List final : public rhi::CommandList {
 public:
  List() : CommandList("list") {}
  void upload(const rhi::BufferHandle&, std::uint64_t, std::span<const std::byte>) override {}
  void copy(const rhi::BufferRange&, const rhi::BufferRange&) override {}
  void fill(const rhi::BufferRange&, std::uint32_t) override {}
  void copy_to_texture(const rhi::BufferRange&, const rhi::TextureHandle&) override {}
  void copy_from_texture(const rhi::TextureHandle&, const rhi::BufferRange&) override {}
  void build_bottom_level(const rhi::AccelerationStructureHandle&, const rhi::BottomLevelDesc&) override {}
  void build_top_level(const rhi::AccelerationStructureHandle&, const rhi::TopLevelDesc&) override {}
  void update_bottom_level(const rhi::AccelerationStructureHandle&, const rhi::BottomLevelDesc&) override {}
  void update_top_level(const rhi::AccelerationStructureHandle&, const rhi::TopLevelDesc&) override {}
  void dispatch(const rhi::DispatchDesc&) override {}
  void trace_rays(const rhi::TraceRaysDesc&) override {}
  void write_timestamp(const rhi::QueryPoolHandle&, std::uint32_t) override {}
};

/// The sentence of the Error that a call throws with this code; "" when it throws none or another.
template <typename Call>
std::string broken_rule(ErrorCode code, const Call& call) {
  try {
    call();
  } catch (const rhi::Error& error) {
    return error.code() == code ? error.what() : "another code: " + std::string(error.what());
  }
  return "";
}

template <typename Desc>
std::string broken_rule(const Desc& desc, const rhi::DeviceInfo& device = able_device(),
                        ErrorCode code = ErrorCode::invalid_argument) {
  return broken_rule(code, [&] { rhi::validation::check(desc, device); });
}

void check_rule(const std::string& sentence, const std::string& part) {
  INFO("the sentence: " << sentence);
  CHECK(sentence.find(part) != std::string::npos);
}

const std::string empty_main = "void main() {}";

rhi::RayTracingPipelineDesc small_pipeline() {
  rhi::RayTracingPipelineDesc desc;
  desc.ray_generation = {plain_shader(ShaderStage::ray_generation, empty_main)};
  desc.miss = {plain_shader(ShaderStage::miss, empty_main)};
  desc.hit_groups = {{.closest_hit = plain_shader(ShaderStage::closest_hit, R"(
                        layout(shaderRecordEXT, std430) buffer Record { uint value; };
                        layout(location = 0) rayPayloadInEXT uint payload;
                        void main() { payload = value; })"),
                      .any_hit = nullptr,
                      .intersection = nullptr}};
  desc.label = "pipeline";
  return desc;
}

rhi::ShaderTableDesc small_table() {
  rhi::ShaderTableDesc desc;
  desc.pipeline = plain_pipeline(small_pipeline());
  desc.ray_generation.records = {{}};
  desc.miss.records = {{}, {.shader = rhi::no_shader, .data = {}}};
  desc.hit.records = {{.shader = 0, .data = std::vector<std::byte>(4)}};
  desc.label = "table";
  return desc;
}

TEST_CASE("boxes: strides, sizes, kinds and flags") {
  rhi::AabbGeometry boxes;
  boxes.boxes = {plain_buffer(72, BufferUsage::acceleration_structure_input)};
  boxes.box_count = 3;
  const auto desc_of = [](rhi::Geometry geometry) {
    return rhi::BottomLevelDesc{.geometries = {std::move(geometry)}, .label = "boxes"};
  };
  CHECK(broken_rule(desc_of(boxes)) == "");
  boxes.box_count = 4;
  check_rule(broken_rule(desc_of(boxes)), "72 bytes where 96 are needed");
  boxes.stride = 28;
  check_rule(broken_rule(desc_of(boxes)), "stride of 28");
  rhi::BottomLevelDesc mixed = desc_of(rhi::AabbGeometry{});
  mixed.geometries.push_back(rhi::TriangleGeometry{});
  check_rule(broken_rule(mixed), "geometry 1 is of another kind");
  rhi::BottomLevelDesc torn = desc_of(rhi::AabbGeometry{});
  torn.flags = rhi::BuildFlags::prefer_fast_build | rhi::BuildFlags::prefer_fast_trace;
  check_rule(broken_rule(torn), "exclude each other");
}

TEST_CASE("vertex formats have strides of their own") {
  rhi::TriangleGeometry triangles;
  triangles.vertices = {plain_buffer(18, BufferUsage::acceleration_structure_input)};
  triangles.vertex_format = rhi::VertexFormat::half3;
  triangles.vertex_stride = 6;
  triangles.vertex_count = 3;
  triangles.triangle_count = 1;
  const auto check = [&] { return broken_rule(rhi::BottomLevelDesc{.geometries = {triangles}, .label = "halves"}); };
  CHECK(check() == "");
  triangles.vertex_stride = 7;
  check_rule(check(), "stride 7");
  triangles.vertex_stride = 4;
  check_rule(check(), "stride 4");
  triangles.vertex_stride = 8;
  check_rule(check(), "18 bytes where 22 are needed");
}

TEST_CASE("updates and compaction need the flag that announced them") {
  const List list;
  const auto structure = plain_structure(rhi::AccelerationStructure::Level::bottom);
  rhi::BottomLevelDesc desc;
  check_rule(
      broken_rule(ErrorCode::invalid_argument, [&] { rhi::validation::check_update(list, structure, desc, desc); }),
      "without BuildFlags::allow_update");
  rhi::BottomLevelDesc updatable;
  updatable.flags = rhi::BuildFlags::allow_update;
  CHECK(broken_rule(ErrorCode::invalid_argument,
                    [&] { rhi::validation::check_update(list, structure, updatable, updatable); }) == "");
  check_rule(
      broken_rule(ErrorCode::invalid_argument, [&] { rhi::validation::check_build(list, structure, updatable, desc); }),
      "other flags");
  check_rule(broken_rule(ErrorCode::invalid_argument,
                         [&] { rhi::validation::check_compaction(structure, rhi::BuildFlags::none, "small"); }),
             "without BuildFlags::allow_compaction");
}

TEST_CASE("ray tracing pipelines: stages, recursion, constants, devices") {
  CHECK(broken_rule(small_pipeline()) == "");
  rhi::RayTracingPipelineDesc desc = small_pipeline();
  desc.ray_generation.clear();
  check_rule(broken_rule(desc), "needs a ray generation shader");
  desc = small_pipeline();
  desc.miss[0] = desc.ray_generation[0];
  check_rule(broken_rule(desc), "of another stage");
  desc = small_pipeline();
  desc.hit_groups[0].any_hit = desc.hit_groups[0].closest_hit;
  check_rule(broken_rule(desc), "hit group 0 any hit");
  desc = small_pipeline();
  desc.max_recursion_depth = 2;
  check_rule(broken_rule(desc), "2 rays in flight");
  desc = small_pipeline();
  desc.specialization = {{.id = 3, .value = 1}};
  check_rule(broken_rule(desc), "no shader has a specialisation constant 3");
  rhi::DeviceInfo device = able_device();
  device.capabilities.ray_tracing_pipeline = false;
  check_rule(broken_rule(small_pipeline(), device, ErrorCode::unsupported), "has no ray tracing pipelines");
}

TEST_CASE("shader tables: records, data and strides") {
  CHECK(broken_rule(small_table()) == "");
  rhi::ShaderTableDesc desc = small_table();
  desc.ray_generation.records.clear();
  check_rule(broken_rule(desc), "needs a ray generation record");
  desc = small_table();
  desc.ray_generation.records[0].shader = rhi::no_shader;
  check_rule(broken_rule(desc), "names no shader");
  desc = small_table();
  desc.miss.records[0].shader = 1;
  check_rule(broken_rule(desc), "miss record 0 names shader 1 of a pipeline that has 1");
  desc = small_table();
  desc.hit.records[0].data.clear();
  check_rule(broken_rule(desc), "0 bytes of data, but its shader reads 4");
  desc = small_table();
  desc.hit.stride = 40;
  check_rule(broken_rule(desc), "no multiple of the device's 32");
  desc.hit.stride = 32;
  check_rule(broken_rule(desc), "less than the 36 bytes");
  desc.hit.stride = 8192;
  check_rule(broken_rule(desc), "more than the device's 4096");
  desc.hit.stride = 64;
  CHECK(broken_rule(desc) == "");
}

TEST_CASE("traces: records, sizes and indirect sizes") {
  rhi::TraceRaysDesc desc;
  check_rule(broken_rule(desc), "needs a shader table");
  desc.table = plain_table(small_table());
  CHECK(broken_rule(desc) == "");
  desc.ray_generation_record = 1;
  check_rule(broken_rule(desc), "ray generation record 1");
  desc.ray_generation_record = 0;
  desc.first_miss_record = 3;
  check_rule(broken_rule(desc), "miss record 3");
  desc.first_miss_record = 2;
  desc.size = {1u << 15, 1u << 16, 1};
  check_rule(broken_rule(desc), "more than the device's 1073741824 invocations");
  desc.size = {0, 1u << 16, 1};
  CHECK(broken_rule(desc) == "");
  const std::array<std::byte, 4> constants{};
  desc.push_constants = constants;
  check_rule(broken_rule(desc), "0 bytes of push constants, but the trace gives 4");
  desc.push_constants = {};
  desc.indirect_size = {plain_buffer(12, BufferUsage::storage)};
  check_rule(broken_rule(desc), "lacks the usage indirect");
  desc.indirect_size = {plain_buffer(12, BufferUsage::indirect)};
  CHECK(broken_rule(desc) == "");
  desc.indirect_size.offset = 4;
  check_rule(broken_rule(desc), "8 bytes where 12 are needed");
  rhi::DeviceInfo device = able_device();
  device.capabilities.trace_rays_indirect = false;
  check_rule(broken_rule(desc, device, ErrorCode::unsupported), "has no indirect traces");
}

TEST_CASE("textures: sides and copies") {
  rhi::TextureDesc desc = {.size = {16, 4, 1}, .label = "picture"};
  CHECK(broken_rule(desc) == "");
  const List list;
  const rhi::BufferHandle buffer = plain_buffer(256, BufferUsage::storage);
  const auto copy = [&](const rhi::BufferRange& range) {
    return broken_rule(ErrorCode::invalid_argument,
                       [&] { rhi::validation::check_texture_copy(list, range, plain_texture(desc)); });
  };
  CHECK(copy({buffer}) == "");
  check_rule(copy({buffer, 16}), "240 bytes where the texture has 256");
  check_rule(copy({buffer, 4}), "no multiple of 16");
  desc.size = {16, 4, 2};
  check_rule(broken_rule(desc), "size 2 in dimension 2");
  desc.dimension = rhi::TextureDimension::d2_array;
  CHECK(broken_rule(desc) == "");
  desc.size = {16, 4, 257};
  check_rule(broken_rule(desc), "257 layers");
  desc.size = {5000, 4, 1};
  check_rule(broken_rule(desc), "5000 texels");
  desc.size = {1, 0, 1};
  check_rule(broken_rule(desc), "size 0");
}

TEST_CASE("bind groups: textures and null structures") {
  rhi::RayTracingPipelineDesc pipeline = small_pipeline();
  pipeline.ray_generation = {plain_shader(ShaderStage::ray_generation, R"(
    layout(binding = 0) uniform accelerationStructureEXT scene;
    layout(binding = 1, rgba32f) uniform image2D picture;
    layout(location = 0) rayPayloadEXT uint payload;
    void main() {
      traceRayEXT(scene, 0u, 0xff, 0, 0, 0, vec3(0), 0.0, vec3(1), 1.0, 0);
      imageStore(picture, ivec2(gl_LaunchIDEXT.xy), vec4(payload));
    })")};
  const rhi::TextureHandle picture =
      plain_texture({.format = rhi::TextureFormat::rgba32_float, .size = {4, 4, 1}, .label = "picture"});
  const rhi::TextureHandle bytes =
      plain_texture({.format = rhi::TextureFormat::rgba8_unorm, .size = {4, 4, 1}, .label = "bytes"});
  rhi::BindGroupDesc desc;
  desc.pipeline = plain_pipeline(pipeline);
  desc.entries = {{.binding = 0, .resource = rhi::AccelerationStructureHandle()}, {.binding = 1, .resource = picture}};
  desc.label = "group";
  CHECK(broken_rule(desc) == "");
  rhi::DeviceInfo device = able_device();
  device.capabilities.null_acceleration_structure = false;
  check_rule(broken_rule(desc, device, ErrorCode::unsupported), "names no acceleration structure");
  desc.entries[1].resource = bytes;
  check_rule(broken_rule(desc), "texture 'bytes' has another format");
  desc.entries[1].resource = rhi::TextureHandle();
  check_rule(broken_rule(desc), "names no texture");
  desc.entries[1].resource = plain_structure(rhi::AccelerationStructure::Level::top);
  check_rule(broken_rule(desc), "is not an acceleration structure in the shader");
}

TEST_CASE("a required subgroup size is a power of two that the device allows, with room for the workgroup") {
  rhi::ComputePipelineDesc desc;
  desc.shader = plain_shader(ShaderStage::compute, "layout(local_size_x = 16, local_size_y = 3) in; void main() {}");
  desc.label = "scan";
  CHECK(broken_rule(desc) == "");
  for (const std::uint32_t size : {16u, 32u}) {
    desc.required_subgroup_size = size;
    CHECK(broken_rule(desc) == "");
  }
  for (const std::uint32_t size : {1u, 4u, 12u, 64u}) {
    desc.required_subgroup_size = size;
    check_rule(broken_rule(desc), "scan: a required subgroup size of " + std::to_string(size) +
                                      ", where the device allows powers of two from 8 to 32");
  }
  desc.required_subgroup_size = 8;
  check_rule(broken_rule(desc),
             "48 invocations in a workgroup are more than the device's 4 subgroups of the required "
             "size 8");
  rhi::DeviceInfo device = able_device();
  device.capabilities.required_subgroup_size = false;
  check_rule(broken_rule(desc, device, ErrorCode::unsupported),
             "scan: device 'able' does not offer required subgroup sizes");
}

TEST_CASE("full subgroups need a workgroup whose first dimension is a multiple of their size") {
  rhi::ComputePipelineDesc desc;
  desc.shader = plain_shader(ShaderStage::compute, "layout(local_size_x_id = 3) in; void main() {}");
  desc.specialization = {{.id = 3, .value = 48}};
  desc.full_subgroups = true;
  desc.label = "scan";
  CHECK(broken_rule(desc) == "");
  desc.required_subgroup_size = 32;
  check_rule(broken_rule(desc),
             "scan: full subgroups need a workgroup size in dimension 0 that is a multiple of the "
             "subgroup size 32, which 48 is not");
  desc.specialization = {{.id = 3, .value = 64}};
  CHECK(broken_rule(desc) == "");
  desc.required_subgroup_size = 0;
  desc.specialization = {{.id = 3, .value = 8}};
  check_rule(broken_rule(desc), "the subgroup size 16, which 8 is not");
  rhi::DeviceInfo device = able_device();
  device.capabilities.full_subgroups = false;
  check_rule(broken_rule(desc, device, ErrorCode::unsupported), "scan: device 'able' does not offer full subgroups");
}

}  // namespace
