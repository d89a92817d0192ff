// The page that `tandem diff` writes about shaders, in a browser.

#include <doctest/doctest.h>

#include <string>

#include "tests/compare/report/browser.hpp"
#include "tests/support/device_test.hpp"
#include "tests/support/process.hpp"
#include "tests/support/scratch_folder.hpp"

namespace tandem::test {
namespace {

/// An image and a buffer that differ where sine and exp2 round otherwise, and one that does not.
constexpr const char* waves = R"(#version 450
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, r32f) uniform image2D picture;
layout(set = 0, binding = 1) buffer Values { float values[]; } result;
layout(set = 0, binding = 2) buffer Counts { uint counts[]; };
void main() {
  const ivec2 p = ivec2(gl_GlobalInvocationID.xy);
  const float wave = sin(float(p.x * 32 + p.y) * 0.0625);
  imageStore(picture, p, vec4(wave));
  result.values[p.y * 32 + p.x] = p.x < 16 ? 1.0 : exp2(wave);
  counts[p.y * 32 + p.x] = p.x;
}
)";

const std::string bound =
    " --image picture=32x32 --buffer Values=zeros:1024 --buffer Counts=zeros:1024 --size 32,32 --a cpu";

}  // namespace

TEST_CASE("the page of a comparison of shaders holds verdict, numbers, pictures and the explanation") {
  for (const std::string& device : device_names()) {
    CAPTURE(device);
    const bool is_reference = device == "cpu";
    ScratchFolder folder;
    folder.write("waves.comp", waves);
    const Outcome outcome = run_tandem(
        "diff waves.comp" + bound + " --b " + (is_reference ? "cpu-exact" : device) + " --report page --out pictures",
        {.folder = folder.path()});
    CAPTURE(outcome.errors);
    REQUIRE(outcome.exit_code == (is_reference ? 0 : 3));
    const std::string page = read_text(folder.path() / "page/index.html");
    // It refers to nothing.
    CHECK(page.find("src=\"http") == std::string::npos);
    CHECK(page.find("href=") == std::string::npos);
    for (const char* name : {"picture_a.png", "picture_b.png"})
      CHECK(std::filesystem::exists(folder.path() / "pictures" / name));
    for (const char* name : {"picture_difference.png", "Values_difference.png"})
      CHECK(std::filesystem::exists(folder.path() / "pictures" / name) != is_reference);
    CHECK_FALSE(std::filesystem::exists(folder.path() / "pictures/Counts_difference.png"));

    const std::string script =
        std::string(is_reference ? "const isReference = true;" : "const isReference = false;") + R"(
      const text_of = (id) => document.getElementById(id)?.textContent ?? "";
      const rows = [...document.querySelectorAll("#resources tbody tr")].map((row) =>
          [...row.children].map((cell) => cell.textContent));
      check(rows.length === 3, `rows ${rows}`);
      check(rows[0][0] === "picture" && rows[0][1] === "1024", `row ${rows[0]}`);
      check(rows[2][0] === "Counts" && rows[2][2] === "1024", `row ${rows[2]}`);
      const images = [...document.querySelectorAll("img")];
      check(images.every((image) => image.complete && image.naturalWidth > 0), "every picture is one");
      check(images[0].naturalWidth === 32 && images[0].naturalHeight === 32, "the picture has its size");
      if (isReference) {
        check(text_of("verdict") === "equal bits", text_of("verdict"));
        check(images.length === 2, `${images.length} pictures`);
      } else {
        check(text_of("verdict") === "explained: within precision", text_of("verdict"));
        check(images.length === 4, `${images.length} pictures`);
        check(text_of("instructions").includes("waves.comp:8") && text_of("instructions").includes("within precision"),
              text_of("instructions"));
        check(text_of("explanation").includes("In lockstep"), text_of("explanation"));
        // Left of the middle, values are equal: the map of the buffer is black there, and not everywhere.
        const canvas = document.createElement("canvas");
        const map = images[3];
        canvas.width = map.naturalWidth;
        canvas.height = map.naturalHeight;
        const context = canvas.getContext("2d");
        context.drawImage(map, 0, 0);
        const pixels = context.getImageData(0, 0, canvas.width, canvas.height).data;
        let left = 0, right = 0;
        for (let i = 0; i < pixels.length / 4; ++i) {
          const isBlack = pixels[4 * i] + pixels[4 * i + 1] + pixels[4 * i + 2] === 0;
          if (!isBlack) i % 32 < 16 ? ++left : ++right;
        }
        check(left === 0 && right > 0, `${left} and ${right} cells differ`);
      }
      check(document.documentElement.scrollWidth <= innerWidth, "nothing is wider than the window");
    )";
    const BrowserOutcome result = run_in_browser(page, script);
    CHECK(result.failures.empty());
    for (const std::string& failure : result.failures) MESSAGE(failure);
    CHECK(result.errors.empty());
    CHECK(result.checks >= 8);
  }
}

}  // namespace tandem::test
