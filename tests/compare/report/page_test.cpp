#include "compare/report/page.hpp"

#include <doctest/doctest.h>

#include <bit>
#include <nlohmann/json.hpp>
#include <string>

#include "compare/image/ulp_histogram.hpp"
#include "compare/metrics/metrics.hpp"
#include "tests/compare/image/images.hpp"
#include "tests/compare/report/browser.hpp"

namespace tandem::compare {
namespace {

using nlohmann::ordered_json;

/// Two images of 64 x 48 pixels of which three differ: 10,20 by a step of one float, 40,5 by much, 63,47 in a NaN.
struct Fixture {
  Fixture() {
    b.pixels[20 * 64 + 10].x = std::bit_cast<float>(std::bit_cast<std::uint32_t>(a.pixels[20 * 64 + 10].x) + 1);
    a.pixels[5 * 64 + 40] = {0.5F, 0.25F, 0.1F};
    b.pixels[5 * 64 + 40] = {0.5F, 0.75F, 0.1F};
    b.pixels[47 * 64 + 63].z = std::bit_cast<float>(0x7fc00000u);
  }

  /// As `tandem diff --json` writes it.
  ordered_json numbers(const std::string& scene) const {
    const Metrics metrics = measure(a, b);
    const UlpHistogram histogram = ulp_histogram(a, b);
    ordered_json bins = ordered_json::array();
    for (const UlpBin& bin : histogram.bins)
      bins.push_back({{"least", bin.least}, {"most", bin.most}, {"values", bin.values}});
    const auto device = [](const char* name) {
      return ordered_json{{"name", name}, {"description", "made <b>up</b>"}, {"driver", "1.0"}};
    };
    return {{"verdict", "differ"},
            {"tier", "tolerance"},
            {"reasons", {"1 pixel has a NaN & that is <one> too many."}},
            {"pixels", metrics.pixels},
            {"bit_equal", metrics.bit_equal},
            {"within_1e5", metrics.within_1e5},
            {"within_1e3", metrics.within_1e3},
            {"max_abs", metrics.max_abs},
            {"mean_abs", metrics.mean_abs},
            {"mean_a", metrics.mean_a},
            {"mean_b", metrics.mean_b},
            {"rmse", metrics.rmse},
            {"psnr", *metrics.psnr},
            {"peak", metrics.peak},
            {"non_finite_a", metrics.non_finite_a},
            {"non_finite_b", metrics.non_finite_b},
            {"ms_a", 1.0 / 3.0},
            {"ms_b", 2e-7},
            {"rays_a", 123456789},
            {"rays_b", 123456788},
            {"device_a", device("cpu")},
            {"device_b", device("vulkan:0")},
            {"trace_a", "query"},
            {"trace_b", "query"},
            {"settings", {{"scene", scene}, {"width", 64}, {"height", 48}, {"spp", 4}, {"depth", 8}}},
            {"thresholds", {{"non_finite", {{"limit", 0.0}, {"reason", "correct shaders produce none"}}}}},
            {"metrics",
             {{"ulp", {{"values", histogram.values}, {"largest", histogram.largest}, {"bins", bins}}},
              {"ssim", 0.987654321},
              {"regions",
               {{{"row", 0},
                 {"column", 0},
                 {"x", 32},
                 {"y", 0},
                 {"width", 32},
                 {"height", 24},
                 {"bit_equal", 0.5},
                 {"rmse", 0.125},
                 {"max_abs", 0.5}}}},
              {"worst_region", 0}}},
            {"probes",
             {{"asked", 1000}, {"findings", {{{"trial", "<mask>"}, {"field", "primitive"}, {"a", 3}, {"b", 4}}}}}},
            {"version", "0.1.0"}};
  }

  std::string page(const std::string& scene, const Classification* classification = nullptr,
                   std::vector<RecordedPath> paths = {}) const {
    const Ranking ranking = rank_pixels(a, b, classification, 100);
    return compare::page({.title = scene,
                          .numbers = numbers(scene).dump(2),
                          .a = a,
                          .b = b,
                          .classification = classification,
                          .ranking = ranking,
                          .paths = std::move(paths)});
  }

  pathtracer::Image a = noise_image(64, 48, 7);
  pathtracer::Image b = a;
};

void check_in_browser(const std::string& page, const std::string& script, std::uint32_t checks) {
  const test::BrowserOutcome outcome = test::run_in_browser(page, script);
  for (const std::string& failure : outcome.failures) FAIL_CHECK(failure);
  for (const std::string& error : outcome.errors) FAIL_CHECK(error);
  CHECK(outcome.checks == checks);
}

TEST_CASE("a page loads nothing from elsewhere") {
  const std::string page = Fixture().page("box.obj");
  CHECK(page.find("http://") == page.find("http://www.w3.org/2000/svg"));  // a name, which nothing is loaded from
  CHECK(page.find("https://") == std::string::npos);
  CHECK(page.find(" src=") == std::string::npos);
  CHECK(page.find("@import") == std::string::npos);
  CHECK(page.find("default-src 'none'") != std::string::npos);
}

TEST_CASE("the page of the largest usual picture stays below 5 MB, noise and all") {
  const pathtracer::Image a = noise_image(512, 512, 1), b = noise_image(512, 512, 2);
  const Ranking ranking = rank_pixels(a, b, nullptr, 10'000);
  const std::string page = compare::page({.title = "noise", .numbers = "{}", .a = a, .b = b, .ranking = ranking});
  CHECK(page.size() < 5'000'000);
}

TEST_CASE("a page says where to look, shows every pixel and each number of the JSON, and its controls work") {
  check_in_browser(Fixture().page("box.obj"), R"js(
    // What it says.
    check(text("title") === "box.obj", "title");
    check(document.title === "box.obj", "title of the window");
    check(text("verdict-sentence").includes("differ"), "verdict");
    check(text("verdict-reasons") === "1 pixel has a NaN & that is <one> too many.", "reasons");
    check(text("look-sentence").startsWith("At pixel 63, 47."), text("look-sentence"));
    check(text("differing").startsWith("3 of 3,072 pixels do not have the same bits."), text("differing"));

    // Each number is that of the JSON.
    const cells = [...document.querySelectorAll("[data-key]")];
    check(cells.length > 40, `${cells.length} cells`);
    for (const cell of cells) {
      const value = cell.dataset.key.split(".").reduce((inner, name) => inner[name], page.numbers);
      const isRounded = typeof value === "number" && Math.abs(Number(cell.textContent) - value) <= 1e-5 * Math.abs(value);
      const shown = Number(cell.textContent) === value || cell.textContent === String(value) ||
        (isRounded && cell.title === String(value));
      if (!shown) check(false, `${cell.dataset.key}: ${cell.textContent}, not ${value}`);
    }
    const keys = new Set(cells.map((cell) => cell.dataset.key));
    for (const key of ["bit_equal", "max_abs", "rmse", "psnr", "ms_a", "rays_b", "device_b.driver", "metrics.ssim", "metrics.ulp.bins.1.values",
                       "metrics.regions.0.rmse", "probes.findings.0.trial", "thresholds.non_finite.limit", "settings.spp"])
      check(keys.has(key), `${key} is not shown`);
    check(document.querySelectorAll("svg.histogram .column").length === page.numbers.metrics.ulp.bins.length, "columns");

    // The button goes to the pixel.
    const {view} = page.viewer;
    byId("look-button").click();
    check(view.selected.x === 63 && view.selected.y === 47 && view.x === 63.5 && view.y === 47.5 && view.scale >= 14, "look");
    check(text("pointed").includes("NaN"), "values of the pixel");
    check(text("paths-heading").includes("63, 47"), "paths of the pixel");
    check(text("path").includes("tandem explain box.obj --pixel 63,47"), "what to do where no path was recorded");
    check(text("position") === "1 of 3", text("position"));

    // One after the other, with keys too.
    byId("next").click();
    check(view.selected.x === 40 && view.selected.y === 5 && text("position") === "2 of 3", "next");
    check(text("pointed").includes("0.25") && text("pointed").includes("0.75"), text("pointed"));
    press("n");
    check(view.selected.x === 10 && view.selected.y === 20, "n");
    check([...document.querySelectorAll("#pointed td:last-child")].map((cell) => cell.textContent).join() === "1,0,0", "ULP");
    press("n");
    press("p");
    check(text("position") === "3 of 3", "around and back");

    // Exact values.
    const exact = new Float32Array(new Uint32Array([page.pixels.wordsA[3 * 1290]]).buffer)[0];
    check(Math.fround(Number(floatText(exact))) === exact, "all digits");
    check(document.querySelector("#pointed td").textContent === floatText(exact), "value of red");

    // What the viewer shows, in pixels of its canvas.
    const color = (x, y) => [...byId("canvas-first").getContext("2d").getImageData(x, y, 1, 1).data].slice(0, 3);
    change("marks", true);
    byId("marks").checked = false;
    byId("marks").dispatchEvent(new Event("change"));
    view.selected = null;
    const placed = () => {
      const box = byId("canvas-first").getBoundingClientRect();
      return [box.width / 2, box.height / 2];
    };
    page.viewer.goTo({x: 40, y: 5}, 30);
    press("a");
    check(byId("mode-a").checked && view.mode === "a", "a");
    const [x, y] = placed();
    const inA = color(x, y);
    check(inA[1] === encoded(0.25), `a shows ${inA}`);
    press("b");
    const inB = color(x, y);
    check(inB[1] === encoded(0.75) && inB[0] === inA[0], `b shows ${inB}`);
    press(" ");
    check(view.mode === "a", "space swaps");

    // Flicker, by button and key, at its rate.
    byId("mode-flicker").click();
    check(!byId("flicker-controls").hidden && view.mode === "flicker", "flicker");
    const states = new Set();
    change("flicker-rate", 8);
    check(view.rate === 8 && text("flicker-rate-value") === "8", "rate");
    for (let i = 0; i < 20; ++i) {
      states.add(color(x, y).join());
      await wait(50);
    }
    check(states.has(inA.join()) && states.has(inB.join()) && states.size === 2, "both flicker");
    byId("flicker-pause").click();
    const paused = view.flickerShowsB;
    await wait(400);
    check(view.flickerShowsB === paused, "paused");
    byId("flicker-pause").click();

    // Slider: left a, right b, by control and by dragging.
    press("s");
    check(view.mode === "slider" && byId("flicker-controls").hidden && !byId("slider-controls").hidden, "slider");
    change("split", 90);
    page.viewer.draw();
    check(color(x, y).join() === inA.join(), "left of the slider is a");
    const width = byId("canvas-first").getBoundingClientRect().width;
    pointer("pointerdown", 0.9 * width, y);
    pointer("pointermove", 0.2 * width, y);
    pointer("pointerup", 0.2 * width, y);
    page.viewer.draw();
    check(Math.abs(view.split - 0.2) < 0.01, `split at ${view.split}`);
    check(color(x, y).join() === inB.join(), "right of the slider is b");

    // Side by side, error, exposure.
    press("d");
    page.viewer.draw();
    check(!byId("pane-second").hidden, "two panes");
    press("e");
    page.viewer.draw();
    check(byId("pane-second").hidden && !byId("error-controls").hidden, "error");
    const absolute = color(x, y);
    check(absolute[0] > 200 && absolute[1] > 0, `0.5 apart is between red and white: ${absolute}`);
    change("error-kind", "ulp");
    page.viewer.draw();
    check(view.error === "ulp" && text("scale").includes("16,777,216"), "ULP");
    check(!byId("error-kind").querySelector('[value="flip"]'), "FLIP was not measured");
    press("a");
    change("exposure", 1);
    page.viewer.draw();
    check(color(x, y)[1] === encoded(0.5) && text("exposure-value") === "+1 EV", "exposure");
    change("exposure", 0);

    // Zoom and pan; a click selects.
    byId("zoom-fit").click();
    check(view.x === 32 && view.y === 24, "fit");
    const fitted = view.scale;
    byId("zoom-in").click();
    check(Math.abs(view.scale - 1.5 * fitted) < 1e-9, "zoom");
    byId("zoom-one").click();
    check(Math.abs(view.scale - 1) < 1e-9, "1:1");
    byId("zoom-fit").click();
    pointer("pointerdown", x, y);
    pointer("pointermove", x + 50, y);
    pointer("pointerup", x + 50, y);
    check(Math.abs(view.x - (32 - 50 / view.scale)) < 1e-9, "drag");
    page.viewer.fit();
    pointer("pointerdown", x + 1, y + 1);
    pointer("pointerup", x + 1, y + 1);
    check(view.selected.x === 32 && view.selected.y === 24, "click");
    check(text("paths-heading").includes("bit-equal"), "state of the pixel");

    // By keyboard alone.
    press("ArrowRight", byId("stage"));
    press("ArrowDown", byId("stage"));
    check(text("announcement").startsWith("Pixel 33, 25: a "), text("announcement"));
    press("Enter", byId("stage"));
    check(view.selected.x === 33 && view.selected.y === 25, "enter");

    // Every control has a name.
    for (const control of document.querySelectorAll("input, select, button, canvas + span"))
      check(control.tagName === "SPAN" || control.ariaLabel || control.textContent || control.labels?.[0]?.textContent, control.outerHTML);
    check(document.documentElement.scrollWidth <= innerWidth, "nothing is wider than the window");
  )js",
                   84);
}

TEST_CASE("classes can be filtered, and a click shows the events of the path") {
  const Fixture fixture;
  Classification classification;
  classification.differing_pixels = 3;
  classification.classed_pixels = 2;
  classification.pixel_counts[static_cast<std::size_t>(DifferenceClass::rounding)] = 1;
  classification.pixel_counts[static_cast<std::size_t>(DifferenceClass::mismatch)] = 1;
  classification.pixels = {{.pixel = {40, 5}, .difference_class = DifferenceClass::mismatch},
                           {.pixel = {10, 20}, .difference_class = DifferenceClass::rounding}};
  pathtracer::PathEvent event;
  event.words[0] = static_cast<std::uint32_t>(pathtracer::EventKind::ray);
  classification.paths = {{.path = {.pixel = {40, 5}, .sample = 2},
                           .divergences = {{.difference_class = DifferenceClass::mismatch,
                                            .segment = 3,
                                            .a = event,
                                            .b = event,
                                            .sentence = "The ray met <i>another</i> triangle."}}}};
  const std::string events = R"json([
    {"segment": 0, "event": "ray", "fields": {"barycentrics": {"a": [0, 1], "b": [0, 0.5], "ulp": 8388608}}},
    {"segment": 0, "event": "camera", "fields": {"sample": {"a": 2}, "origin": {"a": [0, 1, 2.5]}}},
    {"segment": 3, "event": "ray", "fields": {
      "primitive": {"a": 17, "name_a": "triangle 17 (leaf)", "b": 18, "name_b": "triangle 18 (sky)"},
      "t max": {"a": 1.5, "b": 1.25, "ulp": 2097152},
      "t": {"a": 3, "b": 4, "ulp": 2097152}}},
    {"segment": 4, "event": "roulette", "only": "b", "fields": {"survives": {"b": true}}}])json";
  const std::string page =
      fixture.page("box.obj", &classification, {{.path = {.pixel = {40, 5}, .sample = 2}, .events = events}});
  check_in_browser(page, R"js(
    check(text("look-sentence").startsWith("At pixel 40, 5. Its green is 0.25 on cpu and 0.75 on vulkan:0, 66.7 % apart"), text("look-sentence"));
    check(text("look-sentence").endsWith("one of the devices is wrong."), "a mismatch is told");
    const {view} = page.viewer;
    byId("look-button").click();
    check(text("path").includes("sample 2, segment 3: The ray met <i>another</i> triangle."), text("path"));
    const rows = () => [...document.querySelectorAll("table.events tbody tr")].map((row) => [...row.cells].map((cell) => cell.textContent).join("|"));
    check(rows()[0] === "segment 0: ray to camera|2 events, the same", rows()[0]);
    check(rows()[1] === "segment 3: ray|2 of 3 fields differ", rows()[1]);
    check(rows()[2] === "primitive|triangle 17 (leaf)|triangle 18 (sky)|", rows()[2]);
    check(rows()[3] === "t max|1.5|1.25|2,097,152", rows()[3]);
    check(rows()[4] === "segment 4: roulette|only on b", rows()[4]);
    check(rows()[5] === "survives||true|", rows()[5]);
    check(document.querySelector("tr.first").textContent.startsWith("segment 3"), "first difference");
    document.querySelector("#path .check input").click();
    check(rows().includes("origin|0, 1, 2.5|0, 1, 2.5|"), "equal fields");
    check(rows()[0] === "segment 0: ray|the same, but for the digits of barycentrics, on which no result depends", rows()[0]);

    // Counts, and the filter.
    const count = (name) => byId(`class-${name}`).closest("li").querySelector(".count").textContent;
    check(count("mismatch") === "1" && count("rounding") === "1" && count("edge-or-vertex-tie") === "0" && count("not-classed") === "1", "counts");
    check(text("position") === "1 of 3", text("position"));
    press("c");
    page.viewer.goTo({x: 40, y: 5}, 30);
    byId("marks").click();
    view.selected = null;
    page.viewer.draw();
    const box = byId("canvas-first").getBoundingClientRect();
    const center = () => [...byId("canvas-first").getContext("2d").getImageData(box.width / 2, box.height / 2, 1, 1).data].slice(0, 3).join();
    check(center() === rgb(classTable.mismatch.color).join(), `a mismatch is drawn in its colour, not ${center()}`);
    byId("class-mismatch").click();
    page.viewer.draw();
    check(center() !== rgb(classTable.mismatch.color).join(), "left out");
    check(text("position") === "of 2", text("position"));
    byId("next").click();
    check(view.selected.x === 10 && view.selected.y === 20, "the next of the classes that are shown");
    byId("class-rounding").click();
    byId("class-not-classed").click();
    check(text("position") === "none" && byId("next").disabled, "nothing left");
  )js",
                   19);
}

TEST_CASE("names are text, whatever they hold") {
  const std::string scene = "</script><script>window.attacked = true</script><!--<title>&amp;\"'{{data}}";
  check_in_browser(Fixture().page(scene), R"js(
    const scene = "<\/script><script>window.attacked = true<\/script><!--<title>&amp;\"'{{data}}";
    check(!window.attacked, "the name of the scene ran");
    check(text("title") === scene, text("title"));
    check(document.title === scene, document.title);
    check(text("raw").includes("made <b>up</b>"), "text of the JSON");
    check(!document.querySelector("b"), "no markup out of names");
  )js",
                   5);
}

TEST_CASE("images that agree in every bit have nowhere to look") {
  Fixture fixture;
  fixture.b = fixture.a;
  ordered_json numbers = fixture.numbers("box.obj");
  numbers["psnr"] = nullptr;
  numbers["verdict"] = "agree";
  const Ranking ranking = rank_pixels(fixture.a, fixture.b, nullptr, 100);
  const std::string page = compare::page(
      {.title = "box.obj", .numbers = numbers.dump(), .a = fixture.a, .b = fixture.b, .ranking = ranking});
  check_in_browser(page, R"js(
    check(text("look-sentence") === "Nowhere: every pixel has the same bits on both devices.", text("look-sentence"));
    check(byId("look-button").hidden, "no button");
    check(text("position") === "none" && byId("next").disabled, text("position"));
    check(document.querySelector('[data-key="psnr"]').textContent === "none", "no PSNR");
  )js",
                   4);
}

TEST_CASE("a larger picture has exact values where it differs, and says what is not exact") {
  const pathtracer::Image a = noise_image(900, 600, 1);
  pathtracer::Image b = a;
  b.pixels[77].x = std::bit_cast<float>(std::bit_cast<std::uint32_t>(a.pixels[77].x) ^ 1u);
  Fixture fixture;
  const Ranking ranking = rank_pixels(a, b, nullptr, 100);
  const std::string page =
      compare::page({.title = "large", .numbers = fixture.numbers("large").dump(), .a = a, .b = b, .ranking = ranking});
  check_in_browser(page, R"js(
    check(page.data.bytes < 4, `${page.data.bytes} bytes`);
    check(text("precision").includes("too large"), text("precision"));
    byId("look-button").click();
    check(document.querySelector("#pointed td:last-child").textContent === "1", text("pointed"));
    page.viewer.select({x: 500, y: 300});
    check(text("pointed").includes("≈") && text("pointed").includes("bit-equal"), text("pointed"));
  )js",
                   4);
}

}  // namespace
}  // namespace tandem::compare
