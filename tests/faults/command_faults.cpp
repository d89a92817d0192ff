#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <utility>
#include <variant>
#include <vector>

#include "tests/faults/fault.hpp"

namespace tandem::test {
namespace {

DeviceEdits vertices(std::function<float(float)> edit) {
  DeviceEdits edits;
  edits.vertex = [edit = std::move(edit)](std::array<float, 3>& position) {
    for (float& coordinate : position) coordinate = edit(coordinate);
  };
  return edits;
}

DeviceEdits instances(std::function<void(rhi::InstanceDesc&)> edit) {
  DeviceEdits edits;
  edits.instance = std::move(edit);
  return edits;
}

DeviceEdits instances_without(rhi::InstanceFlags flag) {
  return instances([flag](rhi::InstanceDesc& instance) {
    instance.flags = instance.flags & ~static_cast<std::uint32_t>(flag) & 0xffu;
  });
}

/// Of all geometries of triangles in a bottom level.
DeviceEdits triangles(std::function<void(rhi::TriangleGeometry&)> edit) {
  DeviceEdits edits;
  edits.bottom_level = [edit = std::move(edit)](rhi::BottomLevelDesc& desc) {
    for (rhi::Geometry& geometry : desc.geometries)
      if (auto* found = std::get_if<rhi::TriangleGeometry>(&geometry)) edit(*found);
  };
  return edits;
}

/// Rounded towards zero to the 11 bits of a half float.
float in_half_precision(float value) { return std::bit_cast<float>(std::bit_cast<std::uint32_t>(value) & 0xffffe000u); }

/// Up to 16 floats off, equal coordinates alike: half of what the path tracer allows for.
float slightly_off(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  const std::uint32_t hash = bits * 2654435769u >> 27;  // 0 to 31
  return value == 0 ? value : std::bit_cast<float>(bits + hash - 16);
}

bool is_mirrored(const rhi::InstanceDesc& instance) {
  const auto& m = instance.object_to_world;
  return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
             m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]) <
         0;
}

void shrink(std::array<float, 6>& box) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const float margin = 0.1f * (box[axis + 3] - box[axis]);
    box[axis] += margin;
    box[axis + 3] -= margin;
  }
}

/// Only whole blocks arrive; what is shorter than one arrives.
void lose_last_block(const rhi::Buffer&, std::vector<std::byte>& bytes) {
  constexpr std::size_t block = 64;
  if (bytes.size() > block)
    std::fill(bytes.begin() + static_cast<std::ptrdiff_t>(bytes.size() / block * block), bytes.end(), std::byte{0});
}

void add_structure_faults(FaultList& faults) {
  faults.add("positions-in-half-precision", "structures keep 11 bits of a position", plain_scene,
             vertices(in_half_precision), "ray", {"answer"});
  faults.add("indices-of-16-bits", "indices are read as 16 bits each", plain_scene,
             triangles([](rhi::TriangleGeometry& geometry) { geometry.index_format = rhi::IndexFormat::uint16; }),
             "ray", {"answer"});
  faults.add("last-triangle-lost", "a geometry is built without its last triangle", plain_scene,
             triangles([](rhi::TriangleGeometry& geometry) { geometry.triangle_count -= geometry.triangle_count > 0; }),
             "ray", {"answer"});
  faults.add("opaque-forced", "every triangle counts as opaque", transparent_scene,
             triangles([](rhi::TriangleGeometry& geometry) { geometry.flags |= rhi::GeometryFlags::opaque; }), "ray",
             {"answer"});
  DeviceEdits boxes;
  boxes.box = shrink;
  faults.add("boxes-too-small", "boxes lose a tenth of their size on each side", sphere_scene, boxes, "ray",
             {"answer"});
  faults.add("custom-index-not-stored", "instances are built with the custom index 0", sphere_scene,
             instances([](rhi::InstanceDesc& instance) { instance.custom_index = 0; }), "ray", {"answer"});
  DeviceEdits count;
  count.instance_count = [](std::uint32_t& instance_count) { instance_count -= instance_count > 0; };
  faults.add("last-instance-lost", "a top level is built without its last instance", sphere_scene, count, "ray",
             {"answer"});

  DeviceEdits bottom_updates, top_updates;
  bottom_updates.skips_bottom_level_updates = true;
  top_updates.skips_top_level_updates = true;
  faults.add_for_probes("refit-skipped", "updates of a bottom level leave it as it was built", plain_scene,
                        bottom_updates, "refitted bottom level", {"type"});
  faults.add_for_probes("instance-update-skipped", "updates of a top level leave it as it was built", plain_scene,
                        top_updates, "moved top level", {"type"});
  faults.add_for_probes("instance-transposed", "an instance's rotation is transposed", plain_scene,
                        instances([](rhi::InstanceDesc& instance) {
                          for (int row = 0; row < 3; ++row)
                            for (int column = 0; column < row; ++column)
                              std::swap(instance.object_to_world[row][column], instance.object_to_world[column][row]);
                        }),
                        "turned instance", {"type"});
  faults.add_for_probes("mirrored-winding", "a mirrored instance turns its triangles round", plain_scene,
                        instances([](rhi::InstanceDesc& instance) {
                          if (is_mirrored(instance))
                            instance.flags =
                                (instance.flags ^ std::uint32_t(rhi::InstanceFlags::triangle_flip_facing)) & 0xffu;
                        }),
                        "mirrored instance", {"hit kind"});
  faults.add_for_probes("instance-mask-forced", "every instance has the mask 0xff", plain_scene,
                        instances([](rhi::InstanceDesc& instance) { instance.mask = 0xff; }), "instance mask",
                        {"type"});
  faults.add_for_probes("cull-disable-lost", "instances cannot switch culling off", transparent_scene,
                        instances_without(rhi::InstanceFlags::triangle_facing_cull_disable), "culling disabled",
                        {"type", "geometry", "primitive"});
  faults.add_for_probes("flip-facing-lost", "instances cannot turn their triangles round", plain_scene,
                        instances_without(rhi::InstanceFlags::triangle_flip_facing), "flipped facing", {"type"});
  faults.add_for_probes("force-opaque-lost", "instances cannot make their triangles opaque", transparent_scene,
                        instances_without(rhi::InstanceFlags::force_opaque), "forced opaque", {"type"});
  faults.add_for_probes("geometry-transform-ignored", "a geometry's matrix is not applied", plain_scene,
                        triangles([](rhi::TriangleGeometry& geometry) { geometry.transform = {}; }),
                        "transform at build", {"type"});
  faults.add_harmless("positions-off", "structures keep positions up to 16 floats off", glass_scene,
                      vertices(slightly_off), Finder::survey);
}

void add_dispatch_faults(FaultList& faults) {
  DeviceEdits row;
  row.dispatch = [](DispatchEdit& run, const DispatchEdit*) { run.size[1] -= run.size[1] > 1; };
  faults.add_for_picture("last-row-lost", "the last row of workgroups does not run", plain_scene, row);
  DeviceEdits stale;
  stale.dispatch = [](DispatchEdit& run, const DispatchEdit* previous) {
    if (previous != nullptr && previous->size[1] > 1 && run.size[1] > 1) run.push_constants = previous->push_constants;
  };
  faults.add_for_picture("push-constants-stale", "of two tiles the second sees the push constants of the first",
                         plain_scene, stale);
  DeviceEdits fill;
  fill.skips_fills = true;
  faults.add_for_picture("fill-skipped", "filling a buffer does nothing", plain_scene, fill);
  DeviceEdits upload;
  upload.upload = lose_last_block;
  faults.add("upload-cut", "the end of an upload is lost where it does not fill 64 bytes", plain_scene, upload, "ray",
             {"answer"});
  DeviceEdits specialization;
  specialization.specialization = [](std::vector<rhi::SpecializationValue>& values) { values.clear(); };
  faults.add("specialisation-ignored", "specialisation constants keep their defaults", transparent_scene,
             specialization, "ray", {"answer"});
}

}  // namespace

std::vector<Fault> command_faults() {
  FaultList faults;
  add_structure_faults(faults);
  add_dispatch_faults(faults);
  return faults.take();
}

}  // namespace tandem::test
