#include "tests/compare/report/browser.hpp"

#include <doctest/doctest.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string_view>

#include "tests/support/scratch_folder.hpp"

namespace tandem::test {
namespace {

constexpr std::string_view watch = R"(<script>
window.complaints = [];
addEventListener("error", (event) => complaints.push(event.message));
addEventListener("unhandledrejection", (event) => complaints.push(String(event.reason)));
addEventListener("securitypolicyviolation", (event) => complaints.push(`${event.violatedDirective}: ${event.blockedURI}`));
for (const kind of ["error", "warn"]) console[kind] = (...words) => complaints.push(words.join(" "));
</script>)";

constexpr std::string_view begin = R"(<script>
(async () => {
  const failures = [];
  let checks = 0;
  const check = (condition, words) => {
    ++checks;
    if (!condition) failures.push(words);
  };
  const wait = (milliseconds) => new Promise((resolve) => setTimeout(resolve, milliseconds));
  const text = (id) => byId(id).textContent;
  const press = (key, target = document.body) => target.dispatchEvent(new KeyboardEvent("keydown", {key, bubbles: true}));
  const change = (id, value) => {
    byId(id).value = value;
    for (const type of ["input", "change"]) byId(id).dispatchEvent(new Event(type, {bubbles: true}));
  };
  const pointer = (type, x, y) => {
    const box = byId("canvas-first").getBoundingClientRect();
    byId("stage").setPointerCapture = () => {};
    byId("canvas-first").dispatchEvent(new PointerEvent(type, {clientX: box.left + x, clientY: box.top + y, pointerId: 1, bubbles: true}));
  };
  try {
    const page = await window.report;
)";

constexpr std::string_view end = R"(
  } catch (error) {
    failures.push(`${error.message}\n${error.stack}`);
  }
  const result = document.createElement("pre");
  result.id = "test-result";
  result.textContent = btoa(unescape(encodeURIComponent(JSON.stringify({failures, errors: complaints, checks}))));
  document.body.append(result);
})();
</script>)";

std::string decoded_base64(std::string_view text) {
  std::string result;
  std::uint32_t group = 0;
  int bits = 0;
  for (const char character : text) {
    static constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const std::size_t digit = digits.find(character);
    if (digit == std::string_view::npos) break;
    group = (group << 6) | static_cast<std::uint32_t>(digit);
    bits += 6;
    if (bits < 8) continue;
    bits -= 8;
    result += static_cast<char>((group >> bits) & 255u);
  }
  return result;
}

std::string output_of(const std::string& command) {
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), pclose);
  if (!pipe) throw std::runtime_error("cannot run " + command);
  std::string result;
  std::array<char, 65536> buffer{};
  while (const std::size_t count = std::fread(buffer.data(), 1, buffer.size(), pipe.get()))
    result.append(buffer.data(), count);
  return result;
}

std::string inserted(std::string text, std::string_view before, const std::string& what) {
  const std::size_t at = text.rfind(before);
  REQUIRE(at != std::string::npos);
  return text.insert(at, what);
}

}  // namespace

BrowserOutcome run_in_browser(const std::string& page, const std::string& script) {
  REQUIRE_MESSAGE(std::string_view(TANDEM_CHROMIUM) != "",
                  "Chromium is not installed; scripts/setup installs it, then configure again");
  const ScratchFolder folder;  // for the page and the browser's own files
  const std::filesystem::path file = folder.path() / "index.html";
  std::string watched = page;
  const std::size_t title = watched.find("<title>");
  REQUIRE(title != std::string::npos);
  watched.insert(title, watch);
  std::ofstream(file, std::ios::binary) << inserted(watched, "</body>", std::string(begin) + script + std::string(end));
  const std::string sandbox = geteuid() == 0 ? " --no-sandbox" : "";  // it refuses to be root's
  const std::string dom =
      output_of("'" TANDEM_CHROMIUM "' --headless --disable-gpu --window-size=1200,900" + sandbox +
                " --user-data-dir='" + (folder.path() / "profile").string() +
                "' --virtual-time-budget=60000 --dump-dom 'file://" + file.string() + "' 2>/dev/null");
  static constexpr std::string_view tag = "<pre id=\"test-result\">";
  const std::size_t at = dom.find(tag);
  REQUIRE_MESSAGE(at != std::string::npos, "the script did not come to its end");
  const auto json = nlohmann::json::parse(decoded_base64(std::string_view(dom).substr(at + tag.size())));
  return {.failures = json.at("failures"), .errors = json.at("errors"), .checks = json.at("checks")};
}

}  // namespace tandem::test
