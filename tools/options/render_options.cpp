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
  constexpr float any = std::numeric_limits<float>::lowest();
  constexpr float most = 1e30F;

  command.add_option("SCENE", options.scene, "Wavefront OBJ, glTF (.gltf, .glb) or scene description (.json)")
      ->required()
      ->type_name("FILE");
  command.add_flag("--allow-missing-mtl", options.allow_missing_mtl,
                   "Go on with grey or opaque materials, and a warning, where an MTL file or a texture is not there");
  const auto group = [&](const char* name) { return command.add_option_group(name); };
  pathtracer::SceneSettings& settings = options.settings;

  CLI::App& image = *group("Image (what is not given is as the scene's file says, or as in brackets)");
  add_size(image, "--size", options.size, "Width and height in pixels [512x512]");
  add_whole_number(image, "--spp", settings.samples, 1, most_samples, "Samples per pixel [16]");
  add_whole_number(image, "--depth", settings.max_depth, 1, most_depth,
                   "Path segments from the camera on: 1 sees emitters only, 2 adds direct light [8]");
  add_whole_number(image, "--seed", settings.seed, 0, std::numeric_limits<std::uint32_t>::max(),
                   "Seed of the random numbers [0]");

  CLI::App& view = *group("View");
  add_named(view, "--camera", options.camera, pathtracer::camera_names(), "Kind of camera [perspective]");
  add_vector(view, "--camera-position", options.camera_position, any, "X,Y,Z",
             "Where the camera is, in the scene's units [chosen to show the whole scene]");
  add_vector(view, "--camera-target", options.camera_target, any, "X,Y,Z",
             "The point that the camera looks at [chosen, or the scene's centre]");
  add_number(view, "--fov", options.field_of_view, 1.0F, 175.0F, "DEGREES",
             "Vertical field of view [40, or chosen with the camera]");
  add_number(view, "--view-height", options.view_height, 0.0F, most, "LENGTH",
             "Orthographic: height of what the picture shows [what the perspective camera sees at its target]");
  add_number(view, "--lens-radius", options.lens_radius, 0.0F, most, "LENGTH",
             "Radius of the lens: what is out of focus blurs [0]");
  add_number(view, "--focus-distance", options.focus_distance, 0.0F, most, "LENGTH",
             "Distance of what is in focus [that of the target]");
  add_vector(view, "--background", settings.background, 0.0F, "R,G,B",
             "Radiance of rays that leave the scene [0,0,0; 1,1,1 for a scene without emitters]");

  CLI::App& method = *group("Method");
  add_named(method, "--integrator", settings.integrator, pathtracer::integrator_names(),
            "path: all light; direct: lights and their direct light; ambient-occlusion: how open each place is [path]");
  add_named(method, "--sampler", settings.sampler, pathtracer::sampler_names(), "Where samples lie [independent]");
  add_switch(method, "--nee", settings.light_sampling, "Next event estimation: rays to lights at every vertex [on]");
  add_named(method, "--mis", settings.mis, pathtracer::mis_names(),
            "Heuristic by which rays to lights and scattered rays that meet one are weighted [power]");
  add_named(method, "--bsdf-sampling", settings.bsdf_sampling, pathtracer::bsdf_sampling_names(),
            "Directions of scattered rays, for materials that are not perfectly specular [bsdf]");
  add_switch(method, "--roulette", settings.roulette, "Russian roulette ends paths that carry little [on]");
  add_whole_number(method, "--max-diffuse-depth", settings.max_diffuse_depth, 0, most_depth,
                   "Diffuse scattering events of a path [no bound but --depth]");
  add_whole_number(method, "--max-glossy-depth", settings.max_glossy_depth, 0, most_depth, "Glossy ones [likewise]");
  add_whole_number(method, "--max-specular-depth", settings.max_specular_depth, 0, most_depth,
                   "Specular ones [likewise]");
  add_number(method, "--clamp-direct", settings.clamp_direct, 0.0F, most, "RADIANCE",
             "Largest radiance that one sample adds at its first vertex, against fireflies; biased [0: no bound]");
  add_number(method, "--clamp-indirect", settings.clamp_indirect, 0.0F, most, "RADIANCE",
             "The same for later vertices [0: no bound]");
  add_number(method, "--occlusion-length", settings.occlusion_length, 0.0F, most, "LENGTH",
             "Ambient occlusion: how far its rays reach [no bound]");

  CLI::App& execution = *group("Execution");
  add_whole_number(execution, "--threads", options.threads, 0, most_threads,
                   "Worker threads of the CPU device; 0: as many as the machine has");
  add_tracing_mode(
      execution, "--trace", options.trace,
      "How rays are traced: query (ray queries) or pipeline (a ray tracing pipeline); the image is the same "
      "[what the device has, query first]");
  execution.add_flag("--validation", options.validation,
                     "Turn the Vulkan validation layers on; their messages go to standard error");
}

void add_tone_options(CLI::App& command, pathtracer::Tone& tone) {
  CLI::App& group = *command.add_option_group("PNG");
  std::vector<const char*> names;
  for (const auto& named : pathtracer::tone_curve_names()) names.push_back(named.name);
  add_choice(
      group, "--tone-map", names,
      [&tone](std::size_t index) { tone.curve = pathtracer::tone_curve_names()[index].value; },
      "How .png files show radiance: srgb and gamma clamp at 1, reinhard and filmic compress [srgb]");
  add_number(group, "--exposure", tone.exposure, -100.0F, 100.0F, "Stops by which .png files are brightened");
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
  command.add_option_function<std::string>(name, read, description)->type_name("FORM");
}

}  // namespace tandem::tools
