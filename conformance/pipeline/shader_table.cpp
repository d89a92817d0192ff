#include <array>
#include <utility>

#include "conformance/kit/check.hpp"
#include "conformance/pipeline/cases.hpp"
#include "conformance/pipeline/stack.hpp"

// Which record a trace names, and what its shader reads in it. Vulkan: "Shader Binding Table", "Hit Shader Binding
// Table Indexing"; SPIR-V: OpTraceRayKHR.
namespace tandem::conformance {
namespace {

using namespace pipeline;
using rhi::GeometryFlags;
using rhi::no_shader;

/// `count` records of shader 0 that hold the words 0, 1, 2, ...
rhi::ShaderRecords records_with_own_index(std::uint32_t count) {
  rhi::ShaderRecords records;
  for (std::uint32_t i = 0; i < count; ++i) records.records.push_back(record_with(0, i));
  return records;
}

/// A probe over three instances with these SBT offsets, of a structure with three geometries. Ray 3 * i + g meets
/// geometry g of instance i. Every hit record holds its own index.
struct Grid : Probe {
  rhi::AccelerationStructureHandle bottom_level;
};
constexpr std::array<std::uint32_t, 3> grid_offsets = {0, 5, 300};

Grid make_grid(rhi::Device& device) {
  Grid grid;
  std::vector<rhi::Geometry> geometries;
  for (int g = 0; g < 3; ++g)
    geometries.emplace_back(triangles(device, triangle_at({static_cast<float>(2 * g), 0, 0})));
  grid.bottom_level = build_bottom_level(device, std::move(geometries));
  std::vector<rhi::InstanceDesc> instances;
  for (std::size_t i = 0; i < grid_offsets.size(); ++i) {
    instances.push_back(rhi::make_instance(*grid.bottom_level, translation(0, static_cast<float>(2 * i), 0)));
    instances.back().sbt_offset = grid_offsets[i] & 0xFFFFFF;
    for (int g = 0; g < 3; ++g) {
      grid.rays.push_back(through_stack());
      grid.rays.back().origin.x += static_cast<float>(2 * g);
      grid.rays.back().origin.y += static_cast<float>(2 * i);
    }
  }
  grid.scene = build_top_level(device, instances);
  grid.hit_groups = {{.closest_hit = probe::closest_hit}};
  grid.hit = records_with_own_index(400);
  return grid;
}

/// Traces the grid; the record of instance i's geometry g must be `expected(i, g)`.
template <typename Expected>
void check_grid(Context& context, const Grid& grid, const Expected& expected) {
  const ProbeResult result = run(context, grid, "shader table");
  for (std::uint32_t i = 0; i < grid_offsets.size(); ++i)
    for (std::uint32_t g = 0; g < 3; ++g) {
      const Report& report = result.reports[i * 3 + g];
      check_equal("the shader that ran last", report.shader, reporter::closest_hit);
      check_equal(fmt::format("the hit record of instance {}, geometry {}", i, g), report.record, expected(i, g));
    }
}

void instance_offset(Context& context) {
  check_grid(context, make_grid(context.device()), [](std::uint32_t i, std::uint32_t) { return grid_offsets[i]; });
}

void record_offset(Context& context) {
  Grid grid = make_grid(context.device());
  for (TracedRay& ray : grid.rays) ray.record_offset = 15;
  check_grid(context, grid, [](std::uint32_t i, std::uint32_t) { return grid_offsets[i] + 15; });
}

void geometry_stride(Context& context) {
  Grid grid = make_grid(context.device());
  for (TracedRay& ray : grid.rays) ray.record_stride = 15;
  check_grid(context, grid, [](std::uint32_t i, std::uint32_t g) { return grid_offsets[i] + 15 * g; });
}

void offset_and_stride(Context& context) {
  Grid grid = make_grid(context.device());
  for (std::uint32_t k = 0; k < grid.rays.size(); ++k) {
    grid.rays[k].record_offset = k;
    grid.rays[k].record_stride = 2 + k;
  }
  check_grid(context, grid, [](std::uint32_t i, std::uint32_t g) {
    const std::uint32_t k = i * 3 + g;
    return grid_offsets[i] + k + g * (2 + k);
  });
}

void four_bits_of_offset_and_stride(Context& context) {
  // Only the 4 least-significant bits of SBT Offset and SBT Stride are used.
  Grid grid = make_grid(context.device());
  for (TracedRay& ray : grid.rays) {
    ray.record_offset = 0x10 + 3;
    ray.record_stride = 0xFFFFFFE0 + 2;
  }
  check_grid(context, grid, [](std::uint32_t i, std::uint32_t g) { return grid_offsets[i] + 3 + 2 * g; });
}

void first_hit_record(Context& context) {
  Grid grid = make_grid(context.device());
  grid.trace.first_hit_record = 40;
  check_grid(context, grid, [](std::uint32_t i, std::uint32_t) { return grid_offsets[i] + 40; });
}

void different_groups(Context& context) {
  // Every second record names a group that has no closest-hit shader.
  Grid grid = make_grid(context.device());
  grid.hit_groups = {{.closest_hit = probe::closest_hit}, {.any_hit = probe::any_hit}};
  for (std::uint32_t i = 0; i < grid.hit.records.size(); ++i) grid.hit.records[i].shader = i % 2;
  for (TracedRay& ray : grid.rays) ray.record_stride = 1;
  const ProbeResult result = run(context, grid, "shader table");
  for (std::uint32_t i = 0; i < 3; ++i)
    for (std::uint32_t g = 0; g < 3; ++g)
      check_equal(fmt::format("the shader that ran for instance {}, geometry {}", i, g),
                  result.reports[i * 3 + g].shader,
                  (grid_offsets[i] + g) % 2 == 0 ? reporter::closest_hit : reporter::none);
}

/// Rays that miss, with these miss indices; every miss record holds its own index.
Probe missing_rays(rhi::Device& device, const std::vector<std::uint32_t>& indices, Scene& scene) {
  scene = build_scene(device, {triangles(device, triangle_at({0, 0, 0}))});
  Probe probe;
  probe.scene = scene.top_level;
  for (const std::uint32_t index : indices) {
    probe.rays.push_back(through_stack());
    probe.rays.back().origin.x = -5;
    probe.rays.back().miss_index = index;
  }
  probe.miss = records_with_own_index(300);
  return probe;
}

void check_miss_records(Context& context, const Probe& probe, const std::vector<std::uint32_t>& expected) {
  const ProbeResult result = run(context, probe, "shader table");
  for (std::size_t i = 0; i < expected.size(); ++i) {
    check_missed(result.reports[i]);
    check_equal(fmt::format("the miss record of ray {}", i), result.reports[i].record, expected[i]);
  }
}

void miss_index(Context& context) {
  Scene scene;
  check_miss_records(context, missing_rays(context.device(), {0, 1, 17, 256, 299}, scene), {0, 1, 17, 256, 299});
}

void sixteen_bits_of_miss_index(Context& context) {
  // Only the 16 least-significant bits of Miss Index are used.
  Scene scene;
  check_miss_records(context, missing_rays(context.device(), {0x10003, 0xFFFF0101}, scene), {3, 0x101});
}

void first_miss_record(Context& context) {
  Scene scene;
  Probe probe = missing_rays(context.device(), {0, 2}, scene);
  probe.trace.first_miss_record = 33;
  check_miss_records(context, probe, {33, 35});
}

void no_hit_shader(Context& context) {
  // Vulkan: a group handle of zeros runs nothing. The ray still meets the triangle: no miss shader runs.
  StackProbe probe = triangle_stack(context.device(), 1, GeometryFlags::opaque);
  probe.hit.records = {record_of(no_shader)};
  const Report report = run(context, probe, "shader table").reports[0];
  check_equal("the shader that ran last", report.shader, reporter::none);
}

void no_hit_shader_accepts(Context& context) {
  // Not opaque: with no any-hit shader to ask, the candidate counts, and hides what is behind it.
  rhi::Device& device = context.device();
  StackProbe probe = triangle_stack(device, 1);
  probe.built = build_scene(device, {stacked_triangles(device, 1, GeometryFlags::none),
                                     stacked_triangles(device, 1, GeometryFlags::none, -1)});
  probe.scene = probe.built.top_level;
  probe.hit.records = {record_of(no_shader), record_with(0, 1u)};
  probe.rays[0].record_stride = 1;
  const Report report = run(context, probe, "shader table").reports[0];
  check_equal("the shader that ran last", report.shader, reporter::none);
}

void no_miss_shader(Context& context) {
  Scene scene;
  Probe probe = missing_rays(context.device(), {0, 1}, scene);
  probe.miss.records[0] = record_of(no_shader);
  const ProbeResult result = run(context, probe, "shader table");
  check_equal("the shader that ran for the empty record", result.reports[0].shader, reporter::none);
  check_equal("the shader that ran for the record behind it", result.reports[1].shader, reporter::miss);
}

void explicit_strides(Context& context) {
  // Strides far larger than the records.
  Grid grid = make_grid(context.device());
  const std::uint32_t stride = context.device().info().limits.shader_record_alignment * 8;
  grid.hit.stride = stride < 128 ? 256 : stride;
  for (TracedRay& ray : grid.rays) ray.record_stride = 3;
  check_grid(context, grid, [](std::uint32_t i, std::uint32_t g) { return grid_offsets[i] + 3 * g; });
}

void records_of_different_sizes(Context& context) {
  // The words of some records are followed by data that no shader reads.
  Grid grid = make_grid(context.device());
  for (std::uint32_t i = 0; i < grid.hit.records.size(); ++i)
    grid.hit.records[i] = record_with(0, std::array<std::uint32_t, 2>{i, 0xDEADBEEF});
  for (std::uint32_t i = 0; i < grid.hit.records.size(); i += 3) grid.hit.records[i] = record_with(0, i);
  grid.hit.records[1] = record_with(0, std::array<std::uint32_t, 20>{1});
  for (TracedRay& ray : grid.rays) ray.record_stride = 1;
  check_grid(context, grid, [](std::uint32_t i, std::uint32_t g) { return grid_offsets[i] + g; });
}

void data_of_hit_group(Context& context) {
  // One record serves the intersection and the any-hit shader of its group.
  StackProbe probe = box_stack(context.device(), {Plan{.count = 1, .t = {6}, .kind = {1}}});
  probe.hit_groups[0].closest_hit = probe::box_closest_hit;
  probe.hit.records = {record_with(0, 0x40u)};
  const Report hit = run(context, probe, "shader table").reports[0];
  check_equal("the word that the closest-hit shader read", hit.record, 0x40u);
  check_equal("the word that the any-hit shader read", hit.any_hit_records, 0x40u);
  probe.hit_groups[0] = {.intersection = probe::intersection_report};
  const Report box = run(context, probe, "shader table").intersections[0];
  check_equal("the word that the intersection shader read", box.record, 0x40u);
}

/// A record with every kind of member, of 192 bytes, read by a ray generation shader whose result is words.
const std::string large_record_text = R"(
struct Part { vec2 a; uint b; };
layout(shaderRecordEXT, std430) buffer Record {
  vec4 color; uint count; Part parts[3]; mat4 matrix; uint last;
} record;
layout(set = 0, binding = 1, std430) writeonly buffer Results { float results[]; };
void main() {
  results[0] = record.color.w;
  results[1] = float(record.count);
  for (int i = 0; i < 3; ++i) {
    results[2 + 2 * i] = record.parts[i].a.y;
    results[3 + 2 * i] = float(record.parts[i].b);
  }
  for (int i = 0; i < 16; ++i) results[8 + i] = record.matrix[i / 4][i % 4];
  results[24] = float(record.last);
}
)";

void data_layout(Context& context) {
  struct Part {
    float a[2];
    std::uint32_t b;
    std::uint32_t padding;
  };
  struct Record {
    float color[4] = {1, 2, 3, 4};
    std::uint32_t count = 5;
    std::uint32_t padding = 0;
    Part parts[3] = {{{6, 7}, 8, 0}, {{9, 10}, 11, 0}, {{12, 13}, 14, 0}};
    std::uint32_t padding_before_matrix[2] = {};
    float matrix[16] = {20, 21, 22, 23, 24, 25, 26, 27, 28, 29, 30, 31, 32, 33, 34, 35};
    std::uint32_t last = 36;
  };
  static_assert(offsetof(Record, matrix) == 80);
  Launch launch;
  launch.ray_generation.records = {record_with(0, Record{})};
  const auto results = results_of<float>(context, {.ray_generation = {large_record_text}, .max_recursion_depth = 0},
                                         launch, 25, "shader table");
  const float expected[] = {4, 5, 7, 8, 10, 11, 13, 14};
  for (std::size_t i = 0; i < 8; ++i) check_equal(fmt::format("member {}", i), results[i], expected[i]);
  for (std::size_t i = 0; i < 16; ++i)
    check_equal(fmt::format("element {} of the matrix", i), results[8 + i], 20.0F + static_cast<float>(i));
  check_equal("the last member", results[24], 36.0F);
}

const std::string ray_generation_text = R"(
layout(shaderRecordEXT, std430) buffer Record { uint word; } record;
layout(set = 0, binding = 1, std430) writeonly buffer Results { uint results[]; };
void main() { results[gl_LaunchIDEXT.x] = record.word; }
)";
const std::string other_ray_generation_text = R"(
layout(set = 0, binding = 1, std430) writeonly buffer Results { uint results[]; };
void main() { results[gl_LaunchIDEXT.x] = 1000u + gl_LaunchIDEXT.x; }
)";

void ray_generation_record(Context& context) {
  const PipelineText text = {.ray_generation = {ray_generation_text, other_ray_generation_text},
                             .max_recursion_depth = 0};
  Launch launch;
  launch.ray_generation.records = {record_with(0, 11u), record_of(1), record_with(0, 33u)};
  launch.trace.size = {2, 1, 1};
  const std::uint32_t expected[][2] = {{11, 11}, {1000, 1001}, {33, 33}};
  for (std::uint32_t record = 0; record < 3; ++record) {
    launch.trace.ray_generation_record = record;
    const auto results = results_of<std::uint32_t>(context, text, launch, 2, "shader table");
    for (std::size_t i = 0; i < 2; ++i)
      check_equal(fmt::format("what invocation {} of record {} wrote", i, record), results[i], expected[record][i]);
  }
}

}  // namespace

void add_pipeline_shader_table_cases(Cases& cases) {
  const Group group{
      .cases = cases, .name = "ray_tracing_pipeline.sbt", .needs = {&rhi::Capabilities::ray_tracing_pipeline}};
  group.add("instance_offset", "an instance's SBT offset picks the hit record", instance_offset);
  group.add("record_offset", "sbtRecordOffset is added to the instance's", record_offset);
  group.add("geometry_stride", "the geometry index times sbtRecordStride is added", geometry_stride);
  group.add("offset_and_stride", "offset and stride are each ray's own", offset_and_stride);
  group.add("four_bits_of_offset_and_stride", "only the lowest four bits of sbtRecordOffset and sbtRecordStride count",
            four_bits_of_offset_and_stride);
  group.add("first_hit_record", "hit records are counted from first_hit_record on", first_hit_record);
  group.add("different_groups", "records name different hit groups", different_groups);
  group.add("miss_index", "the miss index picks the miss record", miss_index);
  group.add("sixteen_bits_of_miss_index", "only the lowest sixteen bits of the miss index count",
            sixteen_bits_of_miss_index);
  group.add("first_miss_record", "miss records are counted from first_miss_record on", first_miss_record);
  group.add("no_hit_shader", "a hit record without group runs nothing, and its ray does not miss", no_hit_shader);
  group.add("no_hit_shader_accepts", "a hit record without group accepts candidates", no_hit_shader_accepts);
  group.add("no_miss_shader", "a miss record without shader runs nothing", no_miss_shader);
  group.add("explicit_strides", "records may lie further apart than they have to", explicit_strides);
  group.add("records_of_different_sizes", "records of a kind may hold different amounts of data",
            records_of_different_sizes);
  group.add("data_of_hit_group", "all shaders of a hit group read the same record", data_of_hit_group);
  group.add("data_layout", "vectors, structures, arrays and matrices of a record have the layout std430", data_layout);
  group.add("ray_generation_record", "a trace runs the ray generation record that it names", ray_generation_record);
}

}  // namespace tandem::conformance
