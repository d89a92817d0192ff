#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "pathtracer/render/tracing_mode.hpp"
#include "tests/faults/device_edits.hpp"
#include "tests/faults/shader_edits.hpp"

/// Things that a device can do wrong, and what a comparison with one that does not must say of each.
namespace tandem::test {

/// Which part of a comparison a fault shows in first.
enum class Finder {
  nobody,   ///< it changes nothing that anybody asks for
  picture,  ///< pixels differ
  survey,   ///< pixels do not, but what the device reports of a path's hits does
  probes    ///< paths do not either: only rays asked in other ways
};

/// "nobody", "picture", "survey", "probes".
const char* name(Finder finder);

struct Fault {
  std::string name;     ///< a few words with hyphens
  std::string meaning;  ///< what the device does, in a few words more
  std::string scene;    ///< a file of scenes/ or tests/faults/scenes/, which the fault shows in
  pathtracer::TracingMode form = pathtracer::TracingMode::query;
  DeviceEdits edits;

  // What must be said of it.
  bool harmful = true;  ///< false: no mismatch
  Finder finder = Finder::picture;
  std::string event;  ///< the kind of the event where most paths part, or the trial; empty where neither differs
  std::vector<std::string> fields;  ///< of the event or the answer: one of these
  std::uint32_t segment = 0;        ///< the first segment of a path on which the fault can act
};

/// Makes lists of faults.
class FaultList {
 public:
  explicit FaultList(pathtracer::TracingMode form = pathtracer::TracingMode::query) : form_(form) {}

  /// A fault that a path shows at a field of an event.
  void add(std::string name, std::string meaning, std::string scene, DeviceEdits edits, std::string event,
           std::vector<std::string> fields, std::uint32_t segment = 0);
  /// One that shows in what a device reports of a ray's hit, and in nothing that comes of it.
  void add_for_survey(std::string name, std::string meaning, std::string scene, DeviceEdits edits, std::string field);
  /// One that only probes show, and this trial first.
  void add_for_probes(std::string name, std::string meaning, std::string scene, DeviceEdits edits, std::string trial,
                      std::vector<std::string> fields);
  /// One that only the picture shows: every path is recorded as it should be.
  void add_for_picture(std::string name, std::string meaning, std::string scene, DeviceEdits edits);
  void add_harmless(std::string name, std::string meaning, std::string scene, DeviceEdits edits, Finder finder);

  std::vector<Fault> take() { return std::move(faults_); }

 private:
  Fault& append(std::string name, std::string meaning, std::string scene, DeviceEdits edits, Finder finder);

  pathtracer::TracingMode form_;
  std::vector<Fault> faults_;
};

/// Scenes of which the path tracer's shaders need different features: the first two none.
inline constexpr const char* plain_scene = "cornell_box.obj";
inline constexpr const char* glass_scene = "cornell_spheres.obj";
inline constexpr const char* transparent_scene = "foliage.obj";
inline constexpr const char* sphere_scene = "cornell_box_spheres.json";
/// Small things on a ground whose coordinates are a million times as large.
inline constexpr const char* wide_scene = "wide_ground.json";

/// Edits of shaders alone.
DeviceEdits shader_edits(ShaderEdit edit);

/// No fault at all, of which nothing must be found.
std::vector<Fault> no_faults();
/// Faults of a device's ray queries.
std::vector<Fault> query_faults();
/// Faults of the shaders of its ray tracing pipelines.
std::vector<Fault> pipeline_faults();
/// Faults of its shader compiler, in the arithmetic of the path tracer.
std::vector<Fault> shading_faults();
/// Surfaces that it misses: by size, by distance, by region, now and then.
std::vector<Fault> surface_faults();
/// Faults of its buffers, builds and commands.
std::vector<Fault> command_faults();
/// All of them.
std::vector<Fault> all_faults();

}  // namespace tandem::test
