#include "tests/faults/fault.hpp"

#include <iterator>

namespace tandem::test {

const char* name(Finder finder) {
  switch (finder) {
    case Finder::nobody:
      return "nobody";
    case Finder::picture:
      return "picture";
    case Finder::survey:
      return "survey";
    case Finder::probes:
      return "probes";
  }
  return "";
}

Fault& FaultList::append(std::string name, std::string meaning, std::string scene, DeviceEdits edits, Finder finder) {
  Fault& fault = faults_.emplace_back();
  fault.name = std::move(name);
  fault.meaning = std::move(meaning);
  fault.scene = std::move(scene);
  fault.form = form_;
  fault.edits = std::move(edits);
  fault.finder = finder;
  return fault;
}

void FaultList::add(std::string name, std::string meaning, std::string scene, DeviceEdits edits, std::string event,
                    std::vector<std::string> fields, std::uint32_t segment) {
  Fault& fault = append(std::move(name), std::move(meaning), std::move(scene), std::move(edits), Finder::picture);
  fault.event = std::move(event);
  fault.fields = std::move(fields);
  fault.segment = segment;
}

void FaultList::add_for_survey(std::string name, std::string meaning, std::string scene, DeviceEdits edits,
                               std::string field) {
  Fault& fault = append(std::move(name), std::move(meaning), std::move(scene), std::move(edits), Finder::survey);
  fault.event = "ray";
  fault.fields = {std::move(field)};
}

void FaultList::add_for_probes(std::string name, std::string meaning, std::string scene, DeviceEdits edits,
                               std::string trial, std::vector<std::string> fields) {
  Fault& fault = append(std::move(name), std::move(meaning), std::move(scene), std::move(edits), Finder::probes);
  fault.event = std::move(trial);
  fault.fields = std::move(fields);
}

void FaultList::add_for_picture(std::string name, std::string meaning, std::string scene, DeviceEdits edits) {
  append(std::move(name), std::move(meaning), std::move(scene), std::move(edits), Finder::picture);
}

void FaultList::add_harmless(std::string name, std::string meaning, std::string scene, DeviceEdits edits,
                             Finder finder) {
  append(std::move(name), std::move(meaning), std::move(scene), std::move(edits), finder).harmful = false;
}

DeviceEdits shader_edits(ShaderEdit edit) {
  DeviceEdits edits;
  edits.shader = std::move(edit);
  return edits;
}

std::vector<Fault> no_faults() {
  FaultList query, pipeline(pathtracer::TracingMode::pipeline);
  query.add_harmless("none", "all that it should", plain_scene, {}, Finder::nobody);
  query.add_harmless("none-transparent", "likewise", transparent_scene, {}, Finder::nobody);
  query.add_harmless("none-wide", "likewise", wide_scene, {}, Finder::nobody);
  query.add_harmless("none-compiled-anew", "likewise, by shaders that were taken apart and put together", plain_scene,
                     shader_edits([](SpirvModule&, rhi::ShaderStage) { return true; }), Finder::nobody);
  pipeline.add_harmless("none-spheres", "likewise, by a ray tracing pipeline", sphere_scene, {}, Finder::nobody);
  std::vector<Fault> all = query.take();
  for (Fault& fault : pipeline.take()) all.push_back(std::move(fault));
  return all;
}

std::vector<Fault> all_faults() {
  std::vector<Fault> all = no_faults();
  const auto append = [&](std::vector<Fault> faults) {
    all.insert(all.end(), std::make_move_iterator(faults.begin()), std::make_move_iterator(faults.end()));
  };
  append(query_faults());
  append(pipeline_faults());
  append(shading_faults());
  append(surface_faults());
  append(command_faults());
  return all;
}

}  // namespace tandem::test
