#include "tools/render_options.hpp"

#include <limits>

#include "tools/option_values.hpp"

namespace tandem::tools {

void add_render_options(CLI::App& command, RenderOptions& options) {
  // Sums of radiance are floats: beyond 2^24 samples a further one would no longer count.
  constexpr std::uint32_t most_samples = 1U << 24;
  constexpr std::uint32_t most_depth = 1024;
  constexpr std::uint32_t most_threads = 1024;
  constexpr float any = std::numeric_limits<float>::lowest();

  command.add_option("SCENE", options.scene, "Wavefront OBJ file with its MTL files beside it")
      ->required()
      ->type_name("FILE.obj");
  command.add_flag("--allow-missing-mtl", options.allow_missing_mtl,
                   "Go on with grey or opaque materials, and a warning, where an MTL file or a texture is not there");
  const auto group = [&](const char* name) { return command.add_option_group(name); };

  CLI::App& image = *group("Image");
  add_size(image, "--size", options.size, "Width and height in pixels");
  add_whole_number(image, "--spp", options.samples, 1, most_samples, "Samples per pixel");
  add_whole_number(image, "--depth", options.depth, 1, most_depth,
                   "Path segments from the camera on: 1 sees emitters only, 2 adds direct light");
  add_whole_number(image, "--seed", options.seed, 0, std::numeric_limits<std::uint32_t>::max(),
                   "Seed of the random numbers");

  CLI::App& view = *group("View");
  add_vector(view, "--camera-position", options.camera_position, any, "X,Y,Z",
             "Where the camera is, in the scene's units [chosen to show the whole scene]");
  add_vector(view, "--camera-target", options.camera_target, any, "X,Y,Z",
             "The point that the camera looks at [chosen, or the scene's centre]");
  add_number(view, "--fov", options.field_of_view, 1.0F, 175.0F, "DEGREES",
             "Vertical field of view [40, or chosen with the camera]");
  add_vector(view, "--background", options.background, 0.0F, "R,G,B",
             "Radiance of rays that leave the scene [0,0,0; 1,1,1 for a scene without emitters]");

  CLI::App& execution = *group("Execution");
  add_whole_number(execution, "--threads", options.threads, 0, most_threads,
                   "Worker threads of the CPU device; 0: as many as the machine has");
  add_trace_form(execution, "--trace", options.trace,
                 "How rays are traced: query (ray queries) or pipeline (a ray tracing pipeline); the image is the same "
                 "[what the device has, query first]");
  execution.add_flag("--validation", options.validation,
                     "Turn the Vulkan validation layers on; their messages go to standard error");
}

void add_trace_form(CLI::App& command, const std::string& name, std::optional<pathtracer::TraceForm>& value,
                    const std::string& description) {
  const auto read = [name, &value](const std::string& text) {
    for (const pathtracer::TraceForm form : {pathtracer::TraceForm::query, pathtracer::TraceForm::pipeline}) {
      if (text != pathtracer::name(form)) continue;
      value = form;
      return;
    }
    throw CLI::ValidationError(name, "'" + text + "' is neither 'query' nor 'pipeline'");
  };
  command.add_option_function<std::string>(name, read, description)->type_name("FORM");
}

}  // namespace tandem::tools
