// The pages of `tandem bench` and of `tandem study markov`, in a browser.

#include <doctest/doctest.h>

#include <string>

#include "tests/compare/report/browser.hpp"
#include "tests/support/process.hpp"
#include "tests/support/scratch_folder.hpp"

namespace tandem::test {
namespace {

void check_in_browser(const std::string& page, const std::string& script) {
  const BrowserOutcome outcome = run_in_browser(page, script);
  for (const std::string& failure : outcome.failures) FAIL_CHECK(failure);
  for (const std::string& error : outcome.errors) FAIL_CHECK(error);
  CHECK(outcome.checks > 0);
}

/// What a page must not do: fetch something, or let a plot reach out of its frame.
const std::string common = R"(
  check(performance.getEntriesByType("resource").length === 0, "the page fetches something");
  for (const plot of document.querySelectorAll("svg.plot")) {
    const frame = plot.getBoundingClientRect();
    for (const mark of plot.querySelectorAll("circle, rect, path, text")) {
      const box = mark.getBoundingClientRect();
      check(box.left >= frame.left - 1 && box.right <= frame.right + 1 && box.top >= frame.top - 1 &&
            box.bottom <= frame.bottom + 1, `${mark.outerHTML} leaves its plot`);
    }
  }
)";

TEST_CASE("a page of performance has a plot for each option, and a table for each setting") {
  const ScratchFolder folder;
  const Outcome bench = run_tandem(
      {"bench", TANDEM_SOURCE_DIRECTORY "/scenes/cornell_box.obj", "--device", "cpu,cpu-scalar", "--size", "16x16",
       "--vary", "spp=1,2,4", "--vary", "sampler=independent,sobol", "--repeat", "2", "--html", "page.html"},
      {.folder = folder.path()});
  REQUIRE(bench.exit_code == 0);
  check_in_browser(read_text(folder.path() / "page.html"), common + R"(
    const plots = [...document.querySelectorAll("svg.plot")];
    check(plots.length === 2, "there is not a plot for each option");
    const titles = plots.map((plot) => plot.querySelector("text").textContent);
    check(titles[0] === "cornell_box.obj: frame time against spp", titles[0]);
    check(titles[1] === "cornell_box.obj: frame time against sampler", titles[1]);
    // Two devices with two samplers at three sample counts, and a mark of each in the legend.
    check(plots[0].querySelectorAll("title").length === 12, "marks are missing");
    check(document.querySelectorAll("table").length === 6, "there is not a table for each setting");
    check(document.querySelectorAll("tbody tr").length === 12, "there is not a row for each device");
    const link = document.querySelector("a[download]");
    const numbers = JSON.parse(atob(link.href.slice(link.href.indexOf(",") + 1)));
    check(numbers.runs.length === 6 && numbers.format === 2, "the numbers are not in the page");
  )");
}

TEST_CASE("a page of random walks has a plot for each equation") {
  const ScratchFolder folder;
  REQUIRE(
      run_tandem({"study", "markov", "--walks", "256", "--html", "walks.html"}, {.folder = folder.path()}).exit_code ==
      0);
  check_in_browser(read_text(folder.path() / "walks.html"), common + R"(
    const plots = [...document.querySelectorAll("svg.plot")];
    check(plots.length === 3, "there is not a plot for each equation");
    for (const plot of plots) check(plot.textContent.includes("N^-1/2"), "a plot has nothing to compare with");
  )");
}

}  // namespace
}  // namespace tandem::test
