#include "rhi_cpu/tracer.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace tandem::cpu {

TEST_CASE("A visitor that asks for opaque triangles is asked about them, by both tracers") {
  const std::array<float, 18> vertices = {0, 0, 7, 1, 0, 7, 0, 1, 7, 0, 0, 9, 1, 0, 9, 0, 1, 9};
  const GeometryInput triangles =
      TriangleInput{.vertices = std::as_bytes(std::span(vertices)), .vertex_count = 6, .triangle_count = 2};
  rhi::InstanceDesc instance{};
  for (int i = 0; i < 3; ++i) instance.object_to_world[i][i] = 1;
  instance.mask = 0xFF;
  instance.blas_address = 1;
  for (const Tracer::Kind kind : {Tracer::Kind::embree, Tracer::Kind::exact}) {
    const Tracer tracer(kind, {});
    const BuiltBottomLevel bottom = tracer.build_bottom_level({&triangles, 1}, rhi::BuildFlags::none, "bottom");
    const BuiltTopLevel top = tracer.build_top_level(
        {&instance, 1}, [&](std::uint64_t) { return &bottom; }, rhi::BuildFlags::none, "top");
    const kernel::TopLevel& scene = view_of(top);
    const kernel::Ray ray{
        .origin = {0.25f, 0.25f, 0}, .t_min = 0, .direction = {0, 0, 1}, .t_max = 1000, .flags = 0, .mask = 0xFF};
    std::vector<std::uint32_t> visited;
    kernel::CandidateVisitor visitor{
        .context = &visited,
        .triangle =
            [](void* context, const kernel::Hit& candidate) {
              CHECK(candidate.opaque);
              static_cast<std::vector<std::uint32_t>*>(context)->push_back(candidate.primitive_index);
              return candidate.primitive_index == 0 ? kernel::CandidateDecision::ignore
                                                    : kernel::CandidateDecision::commit;
            },
        .box = nullptr};
    kernel::Hit hit;
    CHECK(scene.functions->visit(scene, ray, visitor, hit));
    CHECK(hit.primitive_index == 0);
    CHECK(visited.empty());
    visitor.visits_opaque_triangles = true;
    CHECK(scene.functions->visit(scene, ray, visitor, hit));
    CHECK(hit.primitive_index == 1);
    CHECK(visited.size() == 2);
  }
}

}  // namespace tandem::cpu
