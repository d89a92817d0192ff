#include "pathtracer/load/obj/obj_loader.hpp"

#include <clocale>
#include <cmath>

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "base/error.hpp"
#include "base/srgb.hpp"
#include "tests/support/scratch_folder.hpp"

using namespace tandem::pathtracer;
using tandem::test::ScratchFolder;

namespace {

const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

Scene load(std::string_view text, std::string_view mtl = "", const LoadOptions& options = {}) {
  const ScratchFolder folder;
  if (!mtl.empty()) folder.write("test.mtl", mtl);
  return load_obj(folder.write("test.obj", text), options);
}

std::string error_of(std::string_view text, std::string_view mtl = "") {
  try {
    load(text, mtl);
  } catch (const tandem::Error& error) {
    return error.what();
  }
  return "no error";
}

bool contains(const std::string& text, std::string_view part) { return text.find(part) != std::string::npos; }

bool is_smooth(const GpuTriangle& triangle) { return (triangle.material & triangle_smooth) != 0; }
std::uint32_t material_index(const GpuTriangle& triangle) { return triangle.material & ~triangle_smooth; }

double total_area(const Scene& scene) {
  double area = 0;
  for (const GpuTriangle& triangle : scene.triangles) area += triangle_area(scene, triangle);
  return area;
}

}  // namespace

TEST_CASE("Positive and negative indices, all corner forms, comments, CRLF and joined lines mean the same") {
  for (const char* face : {"f 1 2 3 4\n", "f -4 -3 -2 -1\n", "f 1/1 2/2 3/3 4/4\n", "f 1//1 2//1 3//1 4//1\n",
                           "f 1/1/1 2/2/1 3/3/1 4/4/1\n", "f 1/1/-1 2/2/-1 3/3/-1 4/4/-1 # quad\n", "  f\t1 2 \\\n 3 4",
                           "f 1 2 3 4 \r\n", "g a\r\ns 1\r\no b\r\nf +1 2 3 4\r\n"}) {
    const Scene scene = load(square + "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 1\n" + face);
    CAPTURE(face);
    CHECK(scene.triangles.size() == 2);
    CHECK(scene.positions.size() == 4);
    CHECK(total_area(scene) == doctest::Approx(1));
    CHECK(scene.warnings.empty());
    for (const GpuTriangle& triangle : scene.triangles) CHECK_FALSE(is_smooth(triangle));
  }
}

TEST_CASE("Relative indices count from where they stand") {
  const Scene scene = load("v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 5 0 0\nv 9 0 0\nv 5 2 0\nf -3 -2 -1\n");
  REQUIRE(scene.triangles.size() == 2);
  CHECK(scene.positions[scene.triangles[1].vertices[1]] == glm::vec3(9, 0, 0));
}

TEST_CASE("Numbers are read the same in every locale, in every notation") {
  const std::string previous = std::setlocale(LC_ALL, nullptr);
  std::setlocale(LC_ALL, "de_DE.UTF-8");
  const Scene scene = load("v 1.5 -.25 +2.\nv 1.5e1 -2E-1 1e+1\nv 0 0 0\nf 1 2 3\n");
  std::setlocale(LC_ALL, previous.c_str());
  CHECK(scene.positions[0] == glm::vec3(1.5f, -0.25f, 2));
  CHECK(scene.positions[1] == glm::vec3(15, -0.2f, 10));
}

TEST_CASE("A concave polygon keeps its area") {
  const Scene scene = load("v 0 0 0\nv 4 0 0\nv 4 4 0\nv 2 1 0\nv 0 4 0\nf 1 2 3 4 5\n");
  CHECK(scene.triangles.size() == 3);
  CHECK(total_area(scene) == doctest::Approx(10));
}

TEST_CASE("Vertex normals make a triangle smooth when they differ from its own") {
  const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  const Scene smooth = load(triangle + "vn 0 0 2\nvn 1 0 1\nf 1//1 2//2 3//1\n");
  CHECK(is_smooth(smooth.triangles[0]));
  CHECK(smooth.normals[smooth.triangles[0].vertices[0]] == glm::vec3(0, 0, 1));
  CHECK(smooth.normals[smooth.triangles[0].vertices[1]].x == doctest::Approx(std::sqrt(0.5)));
  // Three decimals of a slanted normal do not make it smooth, nor does one that points to the other side.
  CHECK_FALSE(is_smooth(load("v 0 0 0\nv 1 0 0.7\nv 0 1 0\nvn -0.573 0 0.819\nf 1//1 2//1 3//1\n").triangles[0]));
  CHECK_FALSE(is_smooth(load(triangle + "vn 0 0 -1\nf 1//1 2//1 3//1\n").triangles[0]));
  CHECK_FALSE(is_smooth(load(triangle + "vn 1 0 1\nf 1//1 2//1 3\n").triangles[0]));
  CHECK_FALSE(is_smooth(load("v 0 0 0\nv 1 0 0\nv 2 0 0\nvn 0 1 1\nf 1//1 2//1 3//1\n").triangles[0]));
}

TEST_CASE("Normals without direction are one warning, and their triangles flat") {
  for (const char* normal : {"vn 0 0 0\n", "vn nan nan nan\n", "vn 1e999 0 0\n"}) {
    const Scene scene = load(square + normal + "f 1//1 2//1 3//1\n");
    CHECK_FALSE(is_smooth(scene.triangles[0]));
    CHECK(scene.warnings.size() == 1);
  }
}

TEST_CASE("A position with two normals becomes two vertices, one that is shared stays one") {
  const Scene scene = load(square + "vn 0 1 1\nvn 1 0 1\nf 1//1 2//1 3//1\nf 1//2 3//1 4//1\n");
  CHECK(scene.positions.size() == 5);
  CHECK(scene.normals.size() == 5);
}

TEST_CASE("Materials are found by their whole name") {
  const Scene scene = load(
      "mtllib test.mtl\n" + square + "usemtl  red wall \nf 1 2 3\nusemtl nowhere\nf 1 2 3\nusemtl green\nf 1 3 4\n",
      "newmtl   red wall\nKd 1 0 0\nnewmtl green\nKd 0 1 0\n");
  REQUIRE(scene.triangles.size() == 3);
  CHECK(scene.materials[material_index(scene.triangles[0])].base_color == glm::vec3(1, 0, 0));
  CHECK(scene.materials[material_index(scene.triangles[1])].base_color == glm::vec3(0.5f));
  CHECK(scene.materials[material_index(scene.triangles[2])].base_color == glm::vec3(0, 1, 0));
  CHECK(scene.material_names[material_index(scene.triangles[0])] == "red wall");
  REQUIRE(scene.warnings.size() == 1);
  CHECK(contains(scene.warnings[0], "nowhere"));
}

TEST_CASE("Without a material a face is grey") {
  const Scene scene = load(square + "f 1 2 3\n");
  REQUIRE(scene.materials.size() == 1);
  CHECK(scene.materials[0].base_color == glm::vec3(0.5f));
  CHECK(scene.warnings.empty());
}

TEST_CASE("Without usemtl the only material of the library counts, but not one of several") {
  const std::string text = "mtllib test.mtl\n" + square + "f 1 2 3\n";
  CHECK(load(text, "newmtl a\nKd 1 0 0\n").materials[0].base_color == glm::vec3(1, 0, 0));
  const Scene several = load(text, "newmtl a\nKd 1 0 0\nnewmtl b\nKd 0 1 0\n");
  CHECK(several.materials[material_index(several.triangles[0])].base_color == glm::vec3(0.5f));
}

TEST_CASE("A missing MTL file is an error, unless it is allowed") {
  const std::string text = "mtllib absent.mtl\n" + square + "usemtl a\nf 1 2 3\n";
  CHECK(contains(error_of(text), "absent.mtl' does not exist"));
  const Scene scene = load(text, "", {.allow_missing_mtl = true});
  CHECK(scene.materials[material_index(scene.triangles[0])].base_color == glm::vec3(0.5f));
  CHECK(scene.warnings.size() == 2);
}

TEST_CASE("Degenerate triangles and exact duplicates are kept") {
  const Scene scene = load(square + "f 1 1 2\nf 1 2 3\nf 1 2 3\n");
  CHECK(scene.triangles.size() == 3);
}

TEST_CASE("What cannot be meant is one sentence with file and line") {
  CHECK(contains(error_of("v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n"), "test.obj:2: "));
  CHECK(contains(error_of("v 0 0 0\nv 0 inf 0\nv 0 1 0\nf 1 2 3\n"), "'inf'"));
  CHECK(contains(error_of("v 0 0 0\nv 0 1e39 0\nv 0 1 0\nf 1 2 3\n"), "'1e39'"));
  CHECK(contains(error_of("v 0 0 0\nv 0 1e400 0\nv 0 1 0\nf 1 2 3\n"), "'1e400' is not a finite number"));
  CHECK(contains(error_of("v 0 0 0\nv 0 -2e12 0\nv 0 1 0\nf 1 2 3\n"), "'-2e12' is beyond 1e+12"));
  CHECK(
      contains(error_of("v 1" + std::string(330, '0') + "e-330 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"), "too many digits"));
  CHECK(contains(error_of("v 0 0 0\nv 0 1,5 0\nv 0 1 0\nf 1 2 3\n"), "'1,5'"));
  CHECK(contains(error_of(square + "f 1 2 5\n"), "test.obj:5: the vertex index 5 is out of range: there are 4"));
  CHECK(contains(error_of(square + "f 1 2 -5\n"), "index -5 is out of range"));
  CHECK(contains(error_of(square + "f 0 1 2\n"), "'0' is not a corner"));
  CHECK(contains(error_of(square + "f 1 2 99999999999\n"), "'99999999999' is not a corner"));
  for (const char* corner : {"1///", "1/1/1/", "/1", "//1", "/", "1/x", "1/0", "1//0", "1/1/x", "1/ /"})
    CHECK(contains(error_of(square + "f 2 3 " + corner + "\n"), "is not a corner"));
  CHECK(contains(error_of(square + "f 1 2 x\n"), "'x' is not a corner"));
  CHECK(contains(error_of(square + "f 1 2\n"), "fewer than three corners"));
  CHECK(contains(error_of(square), "holds no triangles"));
  CHECK(contains(error_of(""), "is empty"));
  CHECK(contains(error_of(std::string(64, '\0')), "is not a text"));
  CHECK(contains(error_of("mtllib test.mtl\n" + square + "f 1 2 3\n", "newmtl a\nKd x\n"), "test.mtl:2: "));
  for (const std::string& sentence : {error_of(square), error_of("v 1\n")})
    CHECK(sentence.find('\n') == std::string::npos);
}

TEST_CASE("A byte order mark hides nothing") {
  CHECK(load("\xef\xbb\xbfv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").triangles.size() == 1);
  CHECK(contains(error_of("\xef\xbb\xbf"), "is empty"));
}

TEST_CASE("A coordinate too small for any float is 0") {
  CHECK(load("v 1e-400 -1e-320 1e-50\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").positions[0] == glm::vec3(0));
}

TEST_CASE("A file without end is refused when its first bytes are no text") {
  CHECK_THROWS_AS(load_obj("/dev/zero"), tandem::Error);
}

TEST_CASE("A file that is cut off is an error where it shows") {
  CHECK(contains(error_of(square + "f 1 2 3\nv 1.0 2."), "test.obj:6: a vertex has fewer"));
  CHECK(contains(error_of(square + "f 1 2 3\nf 1 2"), "test.obj:6: a face has fewer"));
  CHECK(contains(error_of(square + "f 1 2 3\nf 1//"), "test.obj:6: a face has fewer"));
}

TEST_CASE("A missing file and a folder are errors") {
  const ScratchFolder folder;
  CHECK_THROWS_AS(load_obj(folder.path() / "absent.obj"), tandem::Error);
  CHECK_THROWS_AS(load_obj(folder.path()), tandem::Error);
}

TEST_CASE("Corners may end in slashes with nothing behind") {
  for (const char* face : {"f 1/ 2/ 3/ 4/\n", "f 1// 2// 3// 4//\n", "f 1/1/ 2/2/ 3/3/ 4/4/\n", "f 1// 2/2/ 3//1 4\n",
                           "f -4// -3// -2/ -1// # comment\n"}) {
    const Scene scene = load(square + "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 1\n" + face);
    CAPTURE(face);
    CHECK(total_area(scene) == doctest::Approx(1));
    CHECK(scene.warnings.empty());
  }
  // What stands before the last slash is kept.
  const Scene scene =
      load("mtllib test.mtl\nusemtl m\n" + square + "vt 0.5 0.25\nf 1/1/ 2/-1/ 3/1/\n", "newmtl m\nKd 0.1 0.2 0.3\n");
  CHECK(scene.materials[material_index(scene.triangles[0])].base_color == glm::vec3(0.1f, 0.2f, 0.3f));
}

TEST_CASE("Normals that the file does not have make triangles flat, with one warning") {
  const Scene scene = load(square + "vn 1 0 1\nf 1//1 2//2 3//-7\nf 1//5 3//6 4//7\nf 1//1 2//1 3//1\n");
  REQUIRE(scene.triangles.size() == 3);
  CHECK_FALSE(is_smooth(scene.triangles[0]));
  CHECK_FALSE(is_smooth(scene.triangles[1]));
  CHECK(is_smooth(scene.triangles[2]));
  REQUIRE(scene.warnings.size() == 1);
  CHECK(contains(scene.warnings[0], "5 corners name normals that the file does not have"));
}

TEST_CASE("A vertex that no face uses may be wrong, with one warning; a face that uses it is an error of its line") {
  for (const char* vertex : {"nan nan nan", "0 inf 0", "0 0 1e400", "0 -2e12 0", "1.#QNAN 0 0", "-nan(ind) 0 0"}) {
    const std::string text = square + "v " + vertex + "\nv 1 2 x\nf 1 2 3 4\n";
    CAPTURE(text);
    const Scene scene = load(text);
    CHECK(total_area(scene) == doctest::Approx(1));
    CHECK(bounds(scene).maximum == glm::vec3(1, 1, 0));
    REQUIRE(scene.warnings.size() == 1);
    CHECK(contains(scene.warnings[0], "2 vertices cannot be used, and no face does"));
    CHECK(contains(error_of(text + "f 1 2 5\n"), "test.obj:5: the vertex coordinate"));
    CHECK(contains(error_of(text + "f 1 2 -1\n"), "test.obj:6: the vertex coordinate 'x'"));
  }
}

TEST_CASE("Statements may come in any order") {
  const std::string mtl = "newmtl red\nKd 0.8 0.1 0.1\nnewmtl green\nKd 0 1 0\n";
  const Scene late = load(square + "usemtl red\nf 1 2 3\nusemtl green\nf 1 3 4\nmtllib test.mtl\n", mtl);
  CHECK(late.warnings.empty());
  CHECK(late.materials[material_index(late.triangles[0])].base_color == glm::vec3(0.8f, 0.1f, 0.1f));
  CHECK(late.materials[material_index(late.triangles[1])].base_color == glm::vec3(0, 1, 0));
  // Elements behind the faces that use them.
  const Scene scene = load("f 1//1 2//2 3//1\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nvn 1 0 1\n");
  CHECK(is_smooth(scene.triangles[0]));
  CHECK(scene.warnings.empty());
  CHECK(contains(error_of("f 1 2 4\nv 0 0 0\nv 1 0 0\nv 0 1 0\n"), "test.obj:1: the vertex index 4"));
  // Relative indices count what stands above.
  CHECK(contains(error_of("f -3 -2 -1\nv 0 0 0\nv 1 0 0\nv 0 1 0\n"), "index -3 is out of range"));
}

TEST_CASE("A material that no face uses may be wrong, and its textures are not read") {
  const std::string text = "mtllib test.mtl\n" + square + "usemtl good\nf 1 2 3\nusemtl bad\n";
  const Scene scene = load(text, "newmtl bad\nKd -1 0 0\nnewmtl good\nKd 1 0 0\nnewmtl other\nmap_Kd absent.png\n");
  CHECK(scene.materials[material_index(scene.triangles[0])].base_color == glm::vec3(1, 0, 0));
  REQUIRE(scene.warnings.size() == 1);
  CHECK(contains(scene.warnings[0], "materials that no face uses are ignored, since they have values that cannot"));
  CHECK(contains(scene.warnings[0], ": bad"));
  CHECK(contains(error_of(text + "f 1 3 4\n", "newmtl bad\nKd -1 0 0\nnewmtl good\n"), "test.mtl:2: Kd"));
  CHECK(contains(error_of(text, "newmtl good\nmap_Kd absent.png\n"), "test.obj:1: the texture"));
}

TEST_CASE("A polygon of many corners is read, and names in sentences are escaped and cut") {
  constexpr int count = 20000;
  std::string text, face = "f";
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * 3.14159265358979 * i / count;
    text += fmt::format("v {} {} 0\n", std::cos(angle), std::sin(angle));
    face += fmt::format(" {}", i + 1);
  }
  const Scene scene = load(text + face + "\n");
  CHECK(scene.triangles.size() == count - 2);
  CHECK(total_area(scene) == doctest::Approx(3.14159265358979).epsilon(1e-5));
  const std::string sentence = error_of(square + "f 1 2 " + std::string(100000, 'x') + "\x1b\n");
  CHECK(sentence.size() < 400);
  CHECK(contains(sentence, "\\x1b' is not a corner"));
}

TEST_CASE("OBJ: colours behind the coordinates are factors on the base colour, encoded as sRGB") {
  const Scene colored = load("v 0 0 0 1 0 0\nv 1 0 0 0 1 0.5\nv 0 1 0\nf 1 2 3\n");
  CHECK(colored.warnings.empty());
  CHECK(colored.materials[0].attributes == vertex_attribute::color);
  REQUIRE(colored.attributes.size() == 3);
  CHECK(colored.attributes[0].color == glm::vec3(1, 0, 0));
  CHECK(colored.attributes[1].color == glm::vec3(0, 1, tandem::srgb_decode(0.5f)));
  CHECK(colored.attributes[2].color == glm::vec3(1));
  CHECK(colored.positions[1] == glm::vec3(1, 0, 0));
  // A weight is none, and white changes nothing.
  CHECK(load("v 0 0 0 1\nv 1 0 0 0.5\nv 0 1 0\nf 1 2 3\n").materials[0].attributes == 0);
  CHECK(load("v 0 0 0 1 1 1\nv 1 0 0 1 1 1\nv 0 1 0 1 1 1\nf 1 2 3\n").materials[0].attributes == 0);
}
