// Renders a scene on two devices and says whether they agree, and if not why: `tandem diff --classify` in a few lines.
// It writes the first picture too. Usage: compare_devices SCENE IMAGE [DEVICE_A [DEVICE_B]]

#include <compare/session/comparison.hpp>
#include <cstdio>
#include <devices/devices.hpp>
#include <exception>
#include <pathtracer/image/image_io.hpp>
#include <pathtracer/load/scene_loader.hpp>
#include <string>
#include <utility>

using namespace tandem;

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fprintf(stderr, "usage: compare_devices SCENE IMAGE [DEVICE_A [DEVICE_B]]\n");
    return 2;
  }
  try {
    const compare::ComparedDevices devices{.a = create_device({.name = argc > 3 ? argv[3] : "cpu"}),
                                           .b = create_device({.name = argc > 4 ? argv[4] : "cpu-exact"}),
                                           .arbiter = create_device({.name = "cpu-exact"})};
    compare::Job job{.scene = pathtracer::load_scene(argv[1]), .settings = {.width = 64, .height = 64}, .samples = 4};
    const compare::Comparison found =
        compare::compare_devices(devices, std::move(job), {.classify = true, .probe = true, .probe_rays = 256});

    std::printf("%s against %s: %s; %g of the pixels bit-equal\n", found.a.device.name.c_str(),
                found.b.device.name.c_str(), compare::name(found.verdict), found.metrics.bit_equal);
    for (const std::string& reason : found.verdict.reasons) std::printf("  %s\n", reason.c_str());
    for (const compare::ClassifiedPath& path : found.classification->paths)
      for (const compare::Divergence& divergence : path.divergences)
        std::printf("  pixel %u,%u: %s\n", path.path.pixel.x, path.path.pixel.y, divergence.sentence.c_str());
    pathtracer::write_image(argv[2], found.a.image, found.a.metadata);
    return found.verdict.outcome != compare::Outcome::differ && found.metrics.mean_a > 0.0 ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "compare_devices: %s\n", error.what());
    return 2;
  }
}
