#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include "compare/session/comparison.hpp"
#include "pathtracer/load/obj/obj_loader.hpp"
#include "tests/faults/faulty_device.hpp"
#include "tests/support/device_test.hpp"
#include "tests/support/scratch_folder.hpp"

/// Neither the size of a scene nor where it lies excuses a wrong device or accuses a right one.

using namespace tandem;
using namespace tandem::test;

namespace {

struct Place {
  double scale = 1;   ///< units of the scene for each of the model
  double origin = 0;  ///< of the model, in x; -0.7 times as much in z
};

/// A ground of 6 by 6, an octahedron of radius 1 on it, and a lamp of 2 by 2 above, on which OBJ's own numbers are
/// written with as many digits as floats have.
std::string model(const Place& place) {
  std::string text = "mtllib model.mtl\n";
  for (const std::array<double, 3>& p : std::vector<std::array<double, 3>>{{-3, -1, -3},
                                                                           {3, -1, -3},
                                                                           {3, -1, 3},
                                                                           {-3, -1, 3},
                                                                           {1, 0, 0},
                                                                           {-1, 0, 0},
                                                                           {0, 1, 0},
                                                                           {0, -1, 0},
                                                                           {0, 0, 1},
                                                                           {0, 0, -1},
                                                                           {-1, 3, -1},
                                                                           {1, 3, -1},
                                                                           {1, 3, 1},
                                                                           {-1, 3, 1}})
    fmt::format_to(std::back_inserter(text), "v {:.9g} {:.9g} {:.9g}\n", place.scale * p[0] + place.origin,
                   place.scale * p[1], place.scale * p[2] - 0.7 * place.origin);
  return text +
         "usemtl grey\nf 4 3 2 1\n"
         "f 5 7 9\nf 9 7 6\nf 6 7 10\nf 10 7 5\nf 9 8 5\nf 6 8 9\nf 10 8 6\nf 5 8 10\n"
         "usemtl lamp\nf 11 12 13 14\n";
}

/// Compares devices at several places with the same programs.
class Places {
 public:
  explicit Places(const rhi::DeviceHandle& right)
      : exact_(device("cpu-exact")),
        good_(compare::with_programs(exact_, right, exact_)),
        bad_(compare::with_programs(exact_, faulty_device(right, edits()), exact_)) {}

  void check(const Place& place) {
    CAPTURE(place.scale);
    CAPTURE(place.origin);
    const ScratchFolder folder;
    folder.write("model.mtl", "newmtl grey\nKd .7 .7 .7\nnewmtl lamp\nKd 0 0 0\nKe 10 10 10\n");
    const pathtracer::Scene scene = pathtracer::load_obj(folder.write("model.obj", model(place)));
    const compare::Comparison good = compared(good_, scene);
    CHECK(good.metrics.mean_a > 0);
    CHECK(good.classification->mismatches() == 0);
    CHECK(good.verdict.outcome == compare::Outcome::agree);

    // The ground has edges of 6, all others are shorter than 3.
    const auto split = static_cast<float>(4 * place.scale);
    for (const bool loses_large : {true, false}) {
      CAPTURE(loses_large);
      *lost_ = [&](const TriangleCorners& corners) { return (longest_edge(corners) > split) == loses_large; };
      const compare::Comparison bad = compared(bad_, scene);
      CHECK(bad.classification->mismatches() > 0);
      CHECK(bad.verdict.outcome == compare::Outcome::differ);
      // All of what differs but the borders of shadows and lost triangles: a tenth of a pixel at either side of an edge
      // is a tie, and a shape of ten pixels has many borders.
      const auto wrong = bad.classification->pixel_counts[static_cast<std::size_t>(compare::DifferenceClass::mismatch)];
      CHECK(5 * wrong >= 4 * bad.classification->classed_pixels);
    }
  }

 private:
  DeviceEdits edits() const {
    DeviceEdits edits;
    edits.loses_triangle = [lost = lost_](const TriangleCorners& corners) { return (*lost)(corners); };
    return edits;
  }

  static compare::Comparison compared(const compare::ComparedDevices& devices, const pathtracer::Scene& scene) {
    compare::Job job{.scene = scene, .settings = {}, .samples = 2, .file = {}};
    job.settings.width = job.settings.height = 24;
    job.settings.max_depth = 4;
    compare::ComparisonOptions options;
    options.classify = true;
    options.classification = {.pixel_limit = 64, .survey_pixels = 64};
    return compare::compare_devices(devices, job, options);
  }

  std::shared_ptr<std::function<bool(const TriangleCorners&)>> lost_ =
      std::make_shared<std::function<bool(const TriangleCorners&)>>();
  rhi::DeviceHandle exact_;
  compare::ComparedDevices good_, bad_;
};

}  // namespace

TANDEM_DEVICE_TEST("From 1e-9 to 1e9 units a right device agrees and one that misses triangles differs") {
  Places places(device_handle);
  for (int decade = -9; decade <= 9; ++decade) places.check({.scale = std::pow(10.0, decade)});
}

TANDEM_DEVICE_TEST("Up to 1e7 units from the origin a right device agrees and one that misses triangles differs") {
  Places places(device_handle);
  for (int decade = 1; decade <= 7; ++decade)
    places.check({.scale = decade < 6 ? 1.0 : 100.0, .origin = std::pow(10.0, decade)});
}
