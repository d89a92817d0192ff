// What the commands say of a scene that would not be seen well as it is.

#include <doctest/doctest.h>

#include <string>

#include "pathtracer/image/image_io.hpp"
#include "tests/support/process.hpp"
#include "tests/support/scratch_folder.hpp"

namespace tandem::test {
namespace {

const std::string square = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nusemtl m\nf 1 2 3 4\n";
const std::string in_front = "--camera-position 0,0,2.7474774 --camera-target 0,0,0 --fov 40 --size 8x8 --spp 64";

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// A scene of one material in the folder.
void write_scene(const ScratchFolder& folder, const std::string& material, const std::string& obj = square) {
  folder.write("m.mtl", "newmtl m\n" + material);
  folder.write("m.obj", "mtllib m.mtl\n" + obj);
}

float mean(const std::filesystem::path& path) {
  const pathtracer::Image image = pathtracer::read_image(path);
  float sum = 0;
  for (const glm::vec3& pixel : image.pixels) sum += pixel.x;
  return sum / static_cast<float>(image.pixels.size());
}

TEST_CASE("A model without light gets a studio, with a note, and none where a background is given") {
  const ScratchFolder folder;
  write_scene(folder, "Kd 0.8\n");
  const Outcome lit = run_tandem("render m.obj --size 32x32 --spp 16 -o lit.exr", {.folder = folder.path()});
  CHECK(lit.exit_code == 0);
  CHECK(contains(lit.errors, "note: m.obj: nothing emits light, so a neutral studio light is added"));
  // A white model stands out from what is behind it.
  const pathtracer::Image image = pathtracer::read_image(folder.path() / "lit.exr");
  CHECK(image.at(0, 0).x < 0.5f * image.at(16, 16).x);
  CHECK(image.at(0, 0).x > 0.1f);
  CHECK(image.at(16, 16).x < 1);

  const Outcome furnace =
      run_tandem("render m.obj " + in_front + " --background 1,1,1 -o furnace.exr", {.folder = folder.path()});
  CHECK(furnace.errors == "");
  CHECK(mean(folder.path() / "furnace.exr") == doctest::Approx(0.8).epsilon(1e-5));
}

TEST_CASE("A picture that is mostly too bright is said to be, with the exposure that helps") {
  const ScratchFolder folder;
  write_scene(folder, "Kd 0\nKe 500\n");
  const Outcome bright = run_tandem("render m.obj " + in_front + " -o x.png", {.folder = folder.path()});
  CHECK(bright.exit_code == 0);
  CHECK(contains(bright.errors, "note: 100 % of the picture is brighter than white; --exposure -9 shows it"));
  CHECK(run_tandem("render m.obj " + in_front + " --exposure -9 -o x.png", {.folder = folder.path()}).errors == "");
  CHECK(run_tandem("render m.obj " + in_front + " -o x.exr", {.folder = folder.path()}).errors == "");
}

TEST_CASE("A dielectric whose mesh is open is warned about, and may be a thin pane") {
  const ScratchFolder folder;
  write_scene(folder, "illum 4\nNi 1.5\n");
  const std::string command = "render m.obj " + in_front + " --background 1,1,1 -o x.exr";
  const Outcome solid = run_tandem(command, {.folder = folder.path()});
  CHECK(contains(solid.errors, "warning: m.obj: the mesh of the dielectric material 'm' is not closed"));
  CHECK(contains(solid.errors, "--thin-panes"));
  const Outcome pane = run_tandem(command + " --thin-panes", {.folder = folder.path()});
  CHECK(pane.errors == "");
  CHECK(mean(folder.path() / "x.exr") == doctest::Approx(1).epsilon(1e-4));
}

TEST_CASE("At map coordinates the camera options count from the file's own 0,0,0") {
  const ScratchFolder folder;
  write_scene(folder, "Kd 0.8\nKe 0.5\n");
  folder.write("far.obj",
               "mtllib m.mtl\nv 449999 99 -5400000\nv 450001 99 -5400000\nv 450001 101 -5400000\nv 449999 101 "
               "-5400000\nusemtl m\nf 1 2 3 4\n");
  const Outcome far = run_tandem(
      "render far.obj --camera-position 450000,100,-5399997.2525226 --camera-target 450000,100,-5400000 --fov 40 "
      "--size 8x8 --spp 1 -o x.exr",
      {.folder = folder.path()});
  CHECK(far.exit_code == 0);
  CHECK(contains(far.errors, "note: far.obj: far from 0,0,0"));
  CHECK(mean(folder.path() / "x.exr") == doctest::Approx(0.5).epsilon(1e-5));
}

}  // namespace
}  // namespace tandem::test
