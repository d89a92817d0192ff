#include "tools/options/render_options.hpp"

#include <limits>

#include "tools/options/option_values.hpp"

namespace tandem::tools {
namespace {

void add_switch(CLI::App& command, const std::string& name, std::optional<bool>& value,
                const std::string& description) {
  static constexpr const char* names[] = {"off", "on"};
  add_choice(
      command, name, names, [&value](std::size_t index) { value = index == 1; }, description);
}

}  // namespace

void add_render_options(CLI::App& command, RenderOptions& options) {
  // Sums of radiance are floats: beyond 2^24 samples a further one would no longer count.
  constexpr std::uint32_t most_samples = 1U << 24;
  constexpr std::uint32_t most_depth = 1024;
  constexpr std::uint32_t most_threads = 1024;
  constexpr float most = 1e30F;

  command.add_option("SCENE", options.scene, "Wavefront OBJ, glTF (.gltf, .glb) or scene description (.json)")
      ->required()
      ->type_name("FILE");
  command.add_flag(
      "--allow-missing-mtl", options.allow_missing_mtl,
      "Warn about a missing MTL file or texture (of any format) and use a grey or opaque material instead of failing");
  command.add_flag("--allow-outside-files", options.allow_outside_files,
                   "Let the scene read files outside of its folder");
  command.add_flag("--thin-panes", options.thin_panes,
                   "Treat a dielectric whose mesh is not closed, such as a window of one face, as a thin pane");
  const auto group = [&](const char* name) { return command.add_option_group(name); };
  pathtracer::SceneSettings& settings = options.settings;

  CLI::App& image = *group("Image (defaults: the scene file, or else the value in brackets)");
  add_size(image, "--size", options.size, "Width and height in pixels [512x512]");
  add_whole_number(image, "--spp", settings.samples, 1, most_samples, "Samples per pixel [16]");
  add_whole_number(image, "--depth", settings.max_depth, 1, most_depth,
                   "Maximum number of path segments: 1 shows emitters only, 2 adds direct light [8]");
  add_whole_number(image, "--seed", settings.seed, 0, std::numeric_limits<std::uint32_t>::max(),
                   "Seed of the random numbers [0]");

  CLI::App& view = *group("View");
  add_named(view, "--camera", options.camera, pathtracer::camera_names(), "Kind of camera [perspective]");
  add_point(view, "--camera-position", options.camera_position,
            "Camera position, in the coordinates of the scene's file [chosen to show the whole scene]");
  add_point(view, "--camera-target", options.camera_target,
            "Point that the camera looks at [the scene's centre, or chosen with the position]");
  add_number(view, "--fov", options.field_of_view, 1.0F, 175.0F, "DEGREES",
             "Vertical field of view [40, or chosen with the camera]");
  add_number(view, "--view-height", options.view_height, 0.0F, most, "LENGTH",
             "Orthographic camera: height of the view [that of the perspective view at its target]");
  add_number(view, "--lens-radius", options.lens_radius, 0.0F, most, "LENGTH",
             "Radius of a thin lens, for depth of field [0: pinhole]");
  add_number(view, "--focus-distance", options.focus_distance, 0.0F, most, "LENGTH",
             "Distance of the plane in focus [that of the target]");
  add_vector(view, "--background", settings.background, 0.0F, "R,G,B",
             "Radiance of rays that leave the scene [0,0,0, and a studio light for a scene without light]");

  CLI::App& method = *group("Method");
  add_named(
      method, "--integrator", settings.integrator, pathtracer::integrator_names(),
      "path: full path tracing; direct: emitters and direct light only; ambient-occlusion: fraction of the hemisphere "
      "that is unoccluded; metropolis: path tracing with Metropolis mutations, for light that is hard to find [path]");
  add_named(method, "--sampler", settings.sampler, pathtracer::sampler_names(),
            "Generator of the sample points [independent]");
  add_switch(method, "--nee", settings.light_sampling, "Next event estimation: sample a light at every vertex [on]");
  add_named(method, "--mis", settings.mis, pathtracer::mis_names(),
            "Heuristic that weights light samples against BSDF samples [power]");
  add_named(method, "--bsdf-sampling", settings.bsdf_sampling, pathtracer::bsdf_sampling_names(),
            "Distribution of scattered directions, for materials that are not perfectly specular [bsdf]");
  add_switch(method, "--roulette", settings.roulette,
             "Russian roulette: end paths of low throughput early, without bias [on]");
  add_whole_number(method, "--max-diffuse-depth", settings.max_diffuse_depth, 0, most_depth,
                   "Maximum number of diffuse scattering events of a path [limited by --depth only]");
  add_whole_number(method, "--max-glossy-depth", settings.max_glossy_depth, 0, most_depth,
                   "Maximum number of glossy scattering events of a path [limited by --depth only]");
  add_whole_number(method, "--max-specular-depth", settings.max_specular_depth, 0, most_depth,
                   "Maximum number of specular scattering events of a path [limited by --depth only]");
  add_number(method, "--clamp-direct", settings.clamp_direct, 0.0F, most, "RADIANCE",
             "Clamp what a sample adds at its first vertex, against fireflies; biased [0: no clamping]");
  add_number(method, "--clamp-indirect", settings.clamp_indirect, 0.0F, most, "RADIANCE",
             "Clamp what a sample adds at later vertices; biased [0: no clamping]");
  add_number(method, "--occlusion-length", settings.occlusion_length, 0.0F, most, "LENGTH",
             "Ambient occlusion: maximum distance of an occluder [unlimited]");
  add_switch(method, "--terminator-offset", settings.terminator_offset,
             "Let rays leave smooth triangles from the round surface that their normals mean, against the shadow "
             "terminator; light may come through meshes that are not closed [off]");

  CLI::App& execution = *group("Execution");
  add_whole_number(execution, "--threads", options.threads, 0, most_threads,
                   "Worker threads of the CPU devices; 0: one per hardware thread");
  add_tracing_mode(execution, "--trace", options.trace,
                   "Tracing mode: query (ray queries) or pipeline (a ray tracing pipeline); both give the same image "
                   "[query where the device supports it]");
  execution.add_flag("--validation", options.validation,
                     "Enable the Vulkan validation layers; their messages go to standard error");
}

void add_tone_options(CLI::App& command, pathtracer::Tone& tone) {
  CLI::App& group = *command.add_option_group("PNG");
  std::vector<const char*> names;
  for (const auto& named : pathtracer::tone_curve_names()) names.push_back(named.name);
  add_choice(
      group, "--tone-map", names,
      [&tone](std::size_t index) { tone.curve = pathtracer::tone_curve_names()[index].value; },
      "Tone curve of .png files: srgb and gamma clamp at 1, reinhard and filmic compress highlights [srgb]");
  add_number(group, "--exposure", tone.exposure, -100.0F, 100.0F, "Exposure of .png files, in stops");
}

void add_tracing_mode(CLI::App& command, const std::string& name, std::optional<pathtracer::TracingMode>& value,
                      const std::string& description) {
  const auto read = [name, &value](const std::string& text) {
    for (const pathtracer::TracingMode form : {pathtracer::TracingMode::query, pathtracer::TracingMode::pipeline}) {
      if (text != pathtracer::name(form)) continue;
      value = form;
      return;
    }
    throw CLI::ValidationError(name, "'" + text + "' is neither 'query' nor 'pipeline'");
  };
  command.add_option_function<std::string>(name, read, description)->type_name("MODE");
}

}  // namespace tandem::tools
