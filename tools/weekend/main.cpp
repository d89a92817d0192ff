// The baseline as a program: renders a scene that Tandem reads, on one thread, and says how long it took.

#include <cstdio>
#include <filesystem>
#include <string>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "base/error.hpp"
#include "pathtracer/image/image_io.hpp"
#include "pathtracer/load/scene_loader.hpp"
#include "tools/weekend/tracer.hpp"

int main(int argc, char** argv) {
  using namespace tandem;
  CLI::App app("Render a scene with a single-threaded path tracer in the spirit of Ray Tracing in One Weekend");
  std::filesystem::path scene_path, output;
  weekend::TraceSettings settings;
  app.add_option("SCENE", scene_path, "Scene to render: .obj, .json, .gltf or .glb")->required();
  app.add_option("--width", settings.width, "Pixels")->check(CLI::Range(1u, 16384u))->capture_default_str();
  app.add_option("--height", settings.height, "Pixels")->check(CLI::Range(1u, 16384u))->capture_default_str();
  app.add_option("--spp", settings.samples, "Samples per pixel")
      ->check(CLI::Range(1u, 1u << 24))
      ->capture_default_str();
  app.add_option("--depth", settings.max_depth, "Path segments from the camera on")
      ->check(CLI::Range(1u, 1000u))
      ->capture_default_str();
  app.add_option("--seed", settings.seed, "Of the random numbers")->capture_default_str();
  app.add_option("-o,--output", output, "Picture to write: .exr or .png; none: only the time")->type_name("FILE");
  CLI11_PARSE(app, argc, argv);
  try {
    if (!output.empty()) pathtracer::check_image_path(output);
    const pathtracer::Scene scene = pathtracer::load_scene(scene_path);
    const weekend::World world = weekend::make_world(scene);
    const float aspect = static_cast<float>(settings.width) / static_cast<float>(settings.height);
    const pathtracer::Camera camera = scene.camera.value_or(pathtracer::automatic_camera(scene, aspect));
    const weekend::Traced traced = weekend::trace(world, camera, settings);
    if (!output.empty()) pathtracer::write_image(output, traced.image, {{"scene", scene.name}, {"device", "weekend"}});
    fmt::print("{} ms, {} rays\n", traced.milliseconds, traced.rays);
    return 0;
  } catch (const std::exception& error) {
    fmt::print(stderr, "tandem_weekend: {}\n", error.what());
    return 2;
  }
}
