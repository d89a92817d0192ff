#include "tools/report/job_report.hpp"

#include <fmt/format.h>

#include <iterator>

namespace tandem::tools {
namespace {

nlohmann::ordered_json optional_json(const std::optional<std::uint32_t>& value) {
  return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(nullptr);
}

nlohmann::ordered_json vector_json(const glm::dvec3& vector) { return {vector.x, vector.y, vector.z}; }

/// A point of a scene in the coordinates of its file.
nlohmann::ordered_json point_json(const compare::JobSummary& job, const glm::vec3& point) {
  return vector_json(job.origin == glm::dvec3(0) ? glm::dvec3(point) : job.origin + glm::dvec3(point));
}

}  // namespace

std::string scene_text(const compare::JobSummary& job) {
  const std::string spheres = job.spheres > 0 ? fmt::format(", {} spheres", job.spheres) : std::string();
  return fmt::format("{} ({} triangles{})", job.scene, job.triangles, spheres);
}

std::string settings_text(const compare::JobSummary& job) {
  const pathtracer::RenderSettings& settings = job.settings;
  const pathtracer::RenderSettings usual;
  std::string text = fmt::format("{}x{}, {} spp, depth {}, seed {}", settings.width, settings.height, job.samples,
                                 settings.max_depth, settings.seed);
  const auto add = [&](bool differs, const char* what, auto value) {
    if (differs) fmt::format_to(std::back_inserter(text), ", {} {}", what, value);
  };
  const auto add_bound = [&](const std::optional<std::uint32_t>& bound, const char* what) {
    add(bound.has_value(), what, bound.value_or(0));
  };
  add(settings.integrator != usual.integrator, "integrator",
      name_of(pathtracer::integrator_names(), settings.integrator));
  add(settings.sampler != usual.sampler, "sampler", name_of(pathtracer::sampler_names(), settings.sampler));
  add(!settings.light_sampling, "nee", "off");
  add(settings.mis != usual.mis, "mis", name_of(pathtracer::mis_names(), settings.mis));
  add(settings.bsdf_sampling != usual.bsdf_sampling, "bsdf sampling",
      name_of(pathtracer::bsdf_sampling_names(), settings.bsdf_sampling));
  add(!settings.roulette, "roulette", "off");
  add_bound(settings.max_diffuse_depth, "diffuse depth");
  add_bound(settings.max_glossy_depth, "glossy depth");
  add_bound(settings.max_specular_depth, "specular depth");
  add(settings.clamp_direct != 0, "clamp direct", settings.clamp_direct);
  add(settings.clamp_indirect != 0, "clamp indirect", settings.clamp_indirect);
  add(settings.occlusion_length != usual.occlusion_length, "occlusion length", settings.occlusion_length);
  add(settings.terminator_offset, "terminator offset", "on");
  return text;
}

nlohmann::ordered_json to_json(const compare::JobSummary& job) {
  const pathtracer::RenderSettings& settings = job.settings;
  nlohmann::ordered_json json = {{"scene", job.scene},
                                 {"scene_hash", job.scene_hash},
                                 {"triangles", job.triangles},
                                 {"spheres", job.spheres},
                                 {"width", settings.width},
                                 {"height", settings.height},
                                 {"spp", job.samples},
                                 {"depth", settings.max_depth},
                                 {"seed", settings.seed},
                                 {"integrator", name_of(pathtracer::integrator_names(), settings.integrator)},
                                 {"sampler", name_of(pathtracer::sampler_names(), settings.sampler)},
                                 {"nee", settings.light_sampling},
                                 {"mis", name_of(pathtracer::mis_names(), settings.mis)},
                                 {"bsdf_sampling", name_of(pathtracer::bsdf_sampling_names(), settings.bsdf_sampling)},
                                 {"roulette", settings.roulette},
                                 {"max_diffuse_depth", optional_json(settings.max_diffuse_depth)},
                                 {"max_glossy_depth", optional_json(settings.max_glossy_depth)},
                                 {"max_specular_depth", optional_json(settings.max_specular_depth)},
                                 {"clamp_direct", settings.clamp_direct},
                                 {"clamp_indirect", settings.clamp_indirect},
                                 {"occlusion_length", settings.occlusion_length}};
  // Where it is off, the JSON is that of versions that did not have it.
  if (settings.terminator_offset) json["terminator_offset"] = true;
  return json;
}

nlohmann::ordered_json settings_json(const compare::JobSummary& job, const pathtracer::Camera& camera,
                                     const glm::vec3& background) {
  nlohmann::ordered_json json = to_json(job);
  json["camera"] = name_of(pathtracer::camera_names(), camera.kind);
  json["camera_position"] = point_json(job, camera.position);
  json["camera_target"] = point_json(job, camera.target);
  json["camera_up"] = vector_json(camera.up);
  json["fov"] = camera.vertical_fov;
  json["view_height"] = camera.height;
  json["lens_radius"] = camera.lens_radius;
  json["focus_distance"] = camera.focus_distance;
  json["background"] = vector_json(background);
  return json;
}

}  // namespace tandem::tools
