#include "pathtracer/load/obj/mtl_loader.hpp"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include "base/error.hpp"
#include "tests/support/scratch_folder.hpp"

using namespace tandem::pathtracer;
using tandem::test::ScratchFolder;

namespace {

struct Loaded {
  std::vector<NamedMaterial> materials;
  std::vector<std::string> warnings;
};

Loaded load(std::string_view text) {
  const ScratchFolder folder;
  Loaded loaded;
  loaded.materials = load_mtl(folder.write("test.mtl", text), loaded.warnings);
  // As where a face has it.
  for (const NamedMaterial& material : loaded.materials)
    if (material.error) throw tandem::Error(*material.error);
  return loaded;
}

std::string error_of(std::string_view text) {
  try {
    load(text);
  } catch (const tandem::Error& error) {
    return error.what();
  }
  return "no error";
}

bool contains(const std::string& text, std::string_view part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("illum chooses the material model") {
  const std::vector<MaterialModel> expected = {
      MaterialModel::diffuse,    MaterialModel::diffuse,    MaterialModel::diffuse,    MaterialModel::mirror,
      MaterialModel::dielectric, MaterialModel::mirror,     MaterialModel::dielectric, MaterialModel::dielectric,
      MaterialModel::mirror,     MaterialModel::dielectric, MaterialModel::diffuse};
  for (std::size_t illum = 0; illum <= 10; ++illum) {
    const Loaded loaded = load("newmtl m\nNi 1.5\nillum " + std::to_string(illum) + "\n");
    REQUIRE(loaded.materials.size() == 1);
    CHECK(loaded.materials[0].material.model == expected[illum]);
  }
  CHECK(load("newmtl m\n").materials.at(0).material.model == MaterialModel::diffuse);
  CHECK(contains(error_of("newmtl m\nillum 11\n"), "test.mtl:2: "));
  CHECK(contains(error_of("newmtl m\nillum x\n"), "'x'"));
}

TEST_CASE("Each material starts from the defaults, and reads its own numbers") {
  const Loaded loaded = load(
      "newmtl glass\r\nKd .1 .2 .3 # comment\r\nKs 0.5\r\nKe +1 2 3e1\r\nTf 0.9 0.8 0.7\r\nNi 1.33\r\nillum 7\r\n"
      "newmtl   default one \nTf 0 0 0\n");
  REQUIRE(loaded.materials.size() == 2);
  const GpuMaterial& glass = loaded.materials[0].material;
  CHECK(glass.base_color == glm::vec3(0.1f, 0.2f, 0.3f));
  CHECK(glass.reflectance == glm::vec3(0.5f));
  CHECK(glass.emission == glm::vec3(1, 2, 30));
  CHECK(glass.transmittance == glm::vec3(0.9f, 0.8f, 0.7f));
  CHECK(glass.ior == 1.33f);
  CHECK(loaded.materials[1].name == "default one");
  CHECK(loaded.materials[1].material.base_color == glm::vec3(0.5f));
  CHECK(loaded.materials[1].material.emission == glm::vec3(0));
  CHECK(loaded.materials[1].material.transmittance == glm::vec3(1));
  CHECK(loaded.warnings.empty());
}

TEST_CASE("A dielectric without an index of refraction is window glass, with a warning") {
  for (const char* text : {"newmtl m\nillum 4\nNi 0\n", "newmtl m\nillum 6\n"}) {
    const Loaded loaded = load(text);
    CHECK(loaded.materials.at(0).material.ior == 1.5f);
    CHECK(loaded.warnings.size() == 1);
  }
  CHECK(load("newmtl m\nillum 4\nNi 1\n").materials.at(0).material.ior == 1);
  CHECK(contains(error_of("newmtl m\nillum 4\nNi -1\n"), "test.mtl:3: "));
}

TEST_CASE("d is opacity, Tr its complement, and d counts where both are given") {
  const auto opacity = [](const std::string& text) {
    return load("newmtl m\n" + text).materials.at(0).material.opacity;
  };
  CHECK(opacity("") == 1);
  CHECK(opacity("d 0.25\n") == 0.25f);
  CHECK(opacity("d -halo 0.25\n") == 0.25f);
  CHECK(opacity("Tr 0.25\n") == 0.75f);
  CHECK(opacity("Tr 1\nd 1\n") == 1);
  CHECK(opacity("d 0.5\nTr 0\n") == 0.5f);
  CHECK(opacity("illum 3\nd 0.5\n") == 0.5f);
  // Exporters give glass a d below 1; that it is glass is said already.
  for (const char* illum : {"4", "6", "7", "9"})
    CHECK(opacity("Ni 1.5\nd 0.5\nillum " + std::string(illum) + "\n") == 1);
  for (const char* wrong : {"d 1.5\n", "d -0.1\n", "d x\n", "Tr 2\n", "Tr nan\n", "d\n"})
    CHECK(contains(error_of("newmtl m\n" + std::string(wrong)), "test.mtl:2: "));
  CHECK(contains(error_of("d 1\n"), "before the first newmtl"));
  CHECK(load("newmtl m\nd 0\n").warnings.size() == 1);
  CHECK(load("newmtl m\nd 0.01\n").warnings.empty());
}

TEST_CASE("Each map is a texture of what it is named after, in a model that looks at it") {
  const Loaded loaded = load(
      "newmtl a\nillum 2\nKs 0.25\nKd 0.5\nmap_Kd a.png\nmap_Ks b.png\nmap_Ke c.png\nmap_Ns d.png\nmap_d e.png\n"
      "bump -bm 0.5 f.png\nnewmtl b\nmap_Kd a.png\nmap_Ks b.png\nmap_Ns d.png\nnorm g.png\n"
      "newmtl c\nPr 0.5\nmap_Pm h.png\n");
  CHECK(loaded.warnings.empty());
  REQUIRE(loaded.materials.size() == 3);
  const auto file = [&](std::size_t material, std::uint32_t GpuMaterial::*member) -> std::string {
    for (const MaterialMap& map : loaded.materials[material].maps)
      if (map.member == member) return map.file.string();
    return "";
  };
  const NamedMaterial& a = loaded.materials[0];
  CHECK(a.maps.size() == 6);
  CHECK(file(0, &GpuMaterial::base_color_texture) == "a.png");
  CHECK(file(0, &GpuMaterial::reflectance_texture) == "b.png");
  CHECK(file(0, &GpuMaterial::emission_texture) == "c.png");
  CHECK(file(0, &GpuMaterial::exponent_texture) == "d.png");
  CHECK(file(0, &GpuMaterial::alpha_texture) == "e.png");
  CHECK(file(0, &GpuMaterial::bump_texture) == "f.png");
  for (const MaterialMap& map : a.maps) {
    const bool is_color = map.file == "a.png" || map.file == "b.png" || map.file == "c.png";
    CHECK(map.kind == (is_color ? MapKind::color : map.file == "e.png" ? MapKind::opacity : MapKind::data));
  }
  CHECK(a.material.normal_scale == 0.5f);
  CHECK(a.material.base_color == glm::vec3(0.5f));
  // What is not given is 1 under a map.
  CHECK(a.material.emission == glm::vec3(1));
  CHECK(loaded.materials[1].material.base_color == glm::vec3(1));
  CHECK(loaded.materials[1].material.model == MaterialModel::diffuse);
  CHECK(loaded.materials[1].maps.size() == 2);
  CHECK(file(1, &GpuMaterial::normal_texture) == "g.png");
  CHECK(loaded.materials[2].material.model == MaterialModel::principled);
  CHECK(loaded.materials[2].material.roughness == 0.5f);
  CHECK(loaded.materials[2].material.metallic == 1);
  CHECK(file(2, &GpuMaterial::metallic_texture) == "h.png");
}

TEST_CASE("A map names a file by its whole name, behind its options") {
  const Loaded loaded = load(
      "newmtl a\nmap_d leaf mask.png\nnewmtl b\n"
      "map_d -clamp on -s 2 3 1 -o 0.5 -mm 0 0.25 -imfchan g -cc on -blendu off -mm 1 2 some\\last.png\n");
  const MaterialMap& plain = loaded.materials.at(0).maps.at(0);
  CHECK(plain.file == "leaf mask.png");
  CHECK(plain.texture.filter == TextureFilter::nearest);
  CHECK(plain.texture.channel == 0);
  CHECK(plain.texture.address == 0);
  const MaterialMap& last = loaded.materials.at(1).maps.at(0);
  CHECK(last.file == "some/last.png");
  CHECK(last.kind == MapKind::data);
  CHECK(last.texture.channel == 1);
  CHECK(last.texture.address == 0x101);
  CHECK(last.texture.u_row == glm::vec3(2, 0, 0.5f));
  CHECK(last.texture.v_row == glm::vec3(0, 3, 0));
  CHECK(last.texture.color_a == glm::vec3(2));
  CHECK(last.texture.alpha_a == 2);
  REQUIRE(loaded.warnings.size() == 1);
  CHECK(contains(loaded.warnings[0], "-blendu, -cc, -mm"));
  for (const char* wrong : {"map_d", "map_Kd -clamp on", "map_Kd -s x.png", "map_Kd -mm 1 x.png", "bump -bm nan x.png"})
    CHECK(contains(error_of("newmtl a\n" + std::string(wrong) + "\n"), "test.mtl:2: "));
}

TEST_CASE("Kd and a lobe of Ks reflect no more than arrives") {
  const Loaded loaded = load(
      "newmtl floor\nillum 2\nKd 0.725 0.71 0.68\nKs 0.3\nNs 80\nnewmtl plain\nillum 2\nKd 0.7\nKs 0.3\n"
      "newmtl dull\nillum 2\nKd 0.7\nKs 0\nNs 80\nnewmtl simple\nillum 1\nKd 0.7\nKs 0.9\n");
  const GpuMaterial& floor = loaded.materials.at(0).material;
  CHECK(floor.model == MaterialModel::blinn_phong);
  CHECK(floor.exponent == 80);
  CHECK(floor.base_color.x + floor.reflectance.x == doctest::Approx(1));
  CHECK(floor.base_color.x / floor.reflectance.x == doctest::Approx(0.725 / 0.3));
  CHECK(loaded.materials.at(1).material.base_color == glm::vec3(0.7f));
  CHECK(loaded.materials.at(1).material.exponent == 10);
  CHECK(loaded.materials.at(2).material.model == MaterialModel::diffuse);
  CHECK(loaded.materials.at(3).material.model == MaterialModel::diffuse);
  REQUIRE(loaded.warnings.size() == 1);
  CHECK(contains(loaded.warnings[0], "material floor"));
}

TEST_CASE("Glass that does not refract but dissolves is a veil, and glass of some roughness is rough") {
  for (const char* illum : {"4", "9"}) {
    const GpuMaterial veil =
        load("newmtl m\nKd 0.9\nNi 0\nd 0.5\nillum " + std::string(illum) + "\n").materials.at(0).material;
    CHECK(veil.model == MaterialModel::diffuse);
    CHECK(veil.opacity == 0.5f);
  }
  const GpuMaterial frosted = load("newmtl m\nNi 1.5\nillum 7\nPr 0.3\n").materials.at(0).material;
  CHECK(frosted.model == MaterialModel::rough_dielectric);
  CHECK(frosted.roughness == 0.3f);
}

TEST_CASE("Textures, gains and repeated names are one warning each, whatever their number") {
  const Loaded loaded =
      load("newmtl a\nmap_Ka a.png\nrefl b.png\nKd 2 0 0\nnewmtl b\nmap_Ka c.png\ndisp d.png\nnewmtl a\nKd 0.1 0 0\n");
  CHECK(loaded.materials.size() == 2);
  CHECK(loaded.materials.at(0).material.base_color == glm::vec3(2, 0, 0));
  REQUIRE(loaded.warnings.size() == 3);
  CHECK(contains(loaded.warnings[0], "disp, map_Ka, refl"));
  CHECK(contains(loaded.warnings[1], "material a"));
  CHECK(contains(loaded.warnings[2], "material a"));
}

TEST_CASE("What cannot be meant is an error that names the line") {
  CHECK(contains(error_of("newmtl a\nKd nan 0 0\n"), "test.mtl:2: "));
  CHECK(contains(error_of("newmtl a\nKd -1 0 0\n"), "test.mtl:2: "));
  CHECK(contains(error_of("newmtl a\nKe 1e39 0 0\n"), "test.mtl:2: "));
  CHECK(contains(error_of("newmtl a\n\nKd 0.5 0.5"), "test.mtl:3: "));
  CHECK(contains(error_of("newmtl a\nKd spectral white.rfl\n"), "'spectral'"));
  CHECK(contains(error_of("newmtl\n"), "test.mtl:1: "));
  CHECK(contains(error_of("Kd 1 1 1\n"), "before the first newmtl"));
  CHECK(contains(error_of(""), "is empty"));
  CHECK(contains(error_of(std::string("newmtl a\0b", 10)), "is not a text"));
  CHECK(load("# nothing\n").materials.empty());
}

TEST_CASE("A value out of range is a warning where the material does not need it") {
  const char* const cases[] = {"Ns -1.960784\nillum 1\n",
                               "Ns nan\nKs 0 0 0\nillum 2\n",
                               "Ni -1\n",
                               "Ni x\nillum 2\nKs 0.1 0.1 0.1\nNs 5\n",
                               "Ks -1 0 0\nillum 1\n",
                               "Tf 1e40 1 1\n",
                               "Tr -1\nd 1\n",
                               "Tf nan nan nan\nillum 3\nKs 1 1 1\nKd -1 -1 -1\n",
                               "d 2\nKd x\nKs -1 0 0\nNs -5\nNi 1.5\nillum 7\n"};
  for (const char* text : cases) {
    CAPTURE(text);
    const Loaded loaded = load("newmtl m\n" + std::string(text));
    REQUIRE(loaded.warnings.size() == 1);
    CHECK(contains(loaded.warnings[0], "cannot be used are ignored"));
    CHECK(contains(loaded.warnings[0], " of m"));
  }
  // The same values where they count.
  for (const char* text : {"Ns -1.960784\nKs 0.1 0.1 0.1\nillum 2\n", "Ni -1\nillum 7\n", "Ks -1 0 0\nillum 3\n",
                           "Tf 1e40 1 1\nillum 4\n", "Tr -1\n", "Kd -1 -1 -1\n", "d 2\nd 1\nd 2\n"})
    CHECK(contains(error_of("newmtl m\n" + std::string(text)), "test.mtl:"));
  CHECK(load("newmtl m\nd 2\nd 1\n").warnings.empty());  // the last one counts
  CHECK(load("newmtl m\nNs -1.960784\nKd 0.3 0.5 0.7\nKs 0 0 0\nd 1\nillum 1\n").materials[0].material.base_color ==
        glm::vec3(0.3f, 0.5f, 0.7f));
}

TEST_CASE("A material that cannot be used is an error of its own, and the others are read") {
  const ScratchFolder folder;
  std::vector<std::string> warnings;
  const auto materials =
      load_mtl(folder.write("test.mtl", "newmtl a\nKd 1 0 0\nnewmtl b\nKd -1 0 0\nnewmtl c\nillum 11\n"), warnings);
  REQUIRE(materials.size() == 3);
  CHECK_FALSE(materials[0].error);
  CHECK(contains(materials[1].error.value_or(""), "test.mtl:4: Kd"));
  CHECK(contains(materials[2].error.value_or(""), "test.mtl:6: illum"));
}

TEST_CASE("Names from a file are escaped and cut in warnings") {
  std::string text;
  for (int i = 0; i < 10; ++i) text += fmt::format("newmtl {}\x1b[31m{}\nd 0\n", std::string(10000, 'x'), i);
  const Loaded loaded = load(text);
  REQUIRE(loaded.warnings.size() == 1);
  CHECK(loaded.warnings[0].size() < 1000);
  CHECK(contains(loaded.warnings[0], "\\x1b[31m0, "));
  CHECK(contains(loaded.warnings[0], "and 6 more"));
}
