// Lists the devices, renders a scene on the CPU twice, on one thread and on all of them, compares the two images, and
// writes one of them.

#include <compare/metrics/metrics.hpp>
#include <compare/verdict/verdict.hpp>
#include <cstdio>
#include <devices/devices.hpp>
#include <exception>
#include <pathtracer/image/image_io.hpp>
#include <pathtracer/load/obj/obj_loader.hpp>
#include <pathtracer/render/renderer.hpp>

namespace {

using namespace tandem;

pathtracer::Image render(const pathtracer::Scene& scene, std::uint32_t threads) {
  rhi::DeviceDesc desc;
  desc.name = "cpu";
  desc.thread_count = threads;
  desc.on_message = [](const rhi::Message& message) { std::fprintf(stderr, "%s\n", message.text.c_str()); };

  pathtracer::RenderSettings settings;
  settings.width = 64;
  settings.height = 64;
  settings.max_depth = 5;

  pathtracer::Renderer renderer(create_device(desc), scene, settings);
  renderer.render(4);
  std::printf("%llu rays in %.1f ms\n", static_cast<unsigned long long>(renderer.ray_count()),
              renderer.device_milliseconds());
  return renderer.image();
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: example SCENE.obj IMAGE.exr\n");
    return 2;
  }
  try {
    for (const rhi::DeviceInfo& device : enumerate_devices()) {
      std::printf("%s: %s, %s\n", device.name.c_str(), device.description.c_str(), device.driver.c_str());
    }
    const pathtracer::Scene scene = pathtracer::load_obj(argv[1]);
    const pathtracer::Image image = render(scene, 1);
    const compare::Metrics metrics = compare::measure(image, render(scene, 0));
    // The result of the CPU device does not depend on the number of threads, so every bit must be the same.
    compare::Thresholds thresholds;
    thresholds.tier = compare::Tier::exact;
    const compare::Verdict verdict = compare::judge({.metrics = metrics}, thresholds);
    std::printf("mean radiance %g, %g of the pixels bit-equal: %s\n", metrics.mean_a, metrics.bit_equal,
                compare::name(verdict));
    pathtracer::write_image(argv[2], image, {});
    return verdict.agree && metrics.mean_a > 0.0 ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "example: %s\n", error.what());
    return 2;
  }
}
