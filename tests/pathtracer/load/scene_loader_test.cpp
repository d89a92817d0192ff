#include <string>

#include <doctest/doctest.h>

#include "base/error.hpp"
#include "pathtracer/load/scene_loader.hpp"
#include "tests/support/scratch_folder.hpp"

using namespace tandem;
using namespace tandem::pathtracer;

TEST_CASE("The extension of a scene tells its format") {
  const test::ScratchFolder folder;
  const char* const triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  CHECK(load_scene(folder.write("lower.obj", triangle)).triangles.size() == 1);
  CHECK(load_scene(folder.write("UPPER.OBJ", triangle)).triangles.size() == 1);
  for (const char* name : {"scene.ply", "scene", "obj"}) {
    std::string sentence;
    try {
      load_scene(folder.write(name, triangle));
    } catch (const Error& error) {
      sentence = error.what();
    }
    CHECK(sentence.find(name) != std::string::npos);
    CHECK(sentence.find("ends in .obj") != std::string::npos);
  }
}
