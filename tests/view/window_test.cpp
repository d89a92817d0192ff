// The viewer as a person uses it: a real window on a virtual screen (Xvfb), keys and a mouse (xdotool).

#include <doctest/doctest.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "pathtracer/image/image_io.hpp"
#include "tests/support/process.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tools/view/display.hpp"

namespace tandem::test {
namespace {

const std::string box = TANDEM_SOURCE_DIRECTORY "/scenes/cornell_box.obj";
constexpr int width = 64, height = 48;
constexpr int window_height = 480;    // the least that the viewer has
constexpr int room = 160;             // left of the panel, the least likewise
constexpr int scaled = room / width;  // whole pixels only
constexpr int left = (room - width * scaled) / 2, top = (window_height - height * scaled) / 2;

class Child {
 public:
  explicit Child(const std::string& line) : pid_(fork()) {
    if (pid_ != 0) return;
    execl("/bin/sh", "sh", "-c", ("exec " + line).c_str(), nullptr);
    _exit(127);
  }
  ~Child() {
    if (pid_ == 0) return;
    kill(pid_, SIGTERM);
    wait();
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  /// The exit code, or -N for signal N.
  int wait() {
    int status = 0;
    waitpid(pid_, &status, 0);
    pid_ = 0;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }

 private:
  pid_t pid_;
};

/// A screen that nobody sees, whose pixels lie in a file.
class Screen {
 public:
  explicit Screen(const std::filesystem::path& folder)
      : folder_(folder),
        server_(fmt::format("Xvfb -displayfd 3 -screen 0 640x512x24 -nolisten tcp -fbdir '{0}' 3> '{0}/display' "
                            "2> '{0}/log'",
                            folder.string())) {
    for (int i = 0; i < 600 && display_.empty(); ++i) {
      std::ifstream(folder_ / "display") >> display_;
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    REQUIRE_MESSAGE(!display_.empty(), "Xvfb does not start: is the package xvfb installed?");
    display_ = ":" + display_;
  }
  const std::string& display() const { return display_; }

  /// What xdotool prints. Words as for a shell.
  std::string hand(const std::string& words) const {
    const Outcome outcome = run_in_shell(fmt::format("DISPLAY={} xdotool {}", display_, words));
    return outcome.output;
  }

  /// The screen's file is an X window dump: a header of 32-bit big-endian numbers, the colours, then BGRX.
  view::Picture part(int x0, int y0, int w, int h) const {
    std::ifstream file(folder_ / "Xvfb_screen0", std::ios::binary);
    const std::string bytes((std::istreambuf_iterator<char>(file)), {});
    const auto number = [&](std::size_t index) {
      std::uint32_t value = 0;
      for (std::size_t i = 0; i < 4; ++i) value = value << 8 | static_cast<std::uint8_t>(bytes.at(index * 4 + i));
      return value;
    };
    const std::size_t first = number(0) + std::size_t{number(19)} * 12, line = number(12);
    REQUIRE(number(11) == 32);
    view::Picture picture{static_cast<std::uint32_t>(w), static_cast<std::uint32_t>(h), {}};
    for (int y = y0; y < y0 + h; ++y)
      for (int x = x0; x < x0 + w; ++x) {
        const std::size_t i = first + static_cast<std::size_t>(y) * line + static_cast<std::size_t>(x) * 4;
        for (const std::size_t channel : {2u, 1u, 0u})
          picture.bytes.push_back(static_cast<std::uint8_t>(bytes.at(i + channel)));
        picture.bytes.push_back(255);
      }
    return picture;
  }

 private:
  std::filesystem::path folder_;
  Child server_;
  std::string display_;
};

/// The viewer's window on the screen.
class Hand {
 public:
  explicit Hand(const Screen& screen) : screen_(&screen) {}

  std::string title() const { return screen_->hand("search --onlyvisible --name Tandem getwindowname"); }
  /// Waits until the title has all of the words; a minute at most, for machines that do much else.
  std::string wait_for(const std::vector<std::string>& words) const {
    std::string now;
    for (int i = 0; i < 600; ++i) {
      now = title();
      if (std::ranges::all_of(words, [&](const std::string& word) { return now.find(word) != std::string::npos; }))
        return now;
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    FAIL("the title is '" << now << "'");
    return now;
  }
  void key(const std::string& name) const { screen_->hand("key " + name); }
  /// Moves the mouse with a button and a key down, from the middle of the picture.
  void drag(int button, int dx, int dy, const std::string& modifier = {}) const {
    const std::string down = modifier.empty() ? "" : "keydown " + modifier;
    const std::string up = modifier.empty() ? "" : "keyup " + modifier;
    // The middle is the line of split, which is to stay.
    const int x = left + width * scaled / 4, y = top + height * scaled / 2;
    screen_->hand(
        fmt::format("mousemove {} {} sleep 0.2 {} mousedown {} sleep 0.1 mousemove {} {} sleep 0.1 mousemove {} {} "
                    "sleep 0.1 mouseup {} {}",
                    x, y, down, button, x + dx / 2, y + dy / 2, x + dx, y + dy, button, up));
  }

 private:
  const Screen* screen_;
};

nlohmann::json saved(const Hand& hand, const std::filesystem::path& file) {
  std::filesystem::remove(file);
  hand.key("ctrl+s");
  for (int i = 0; i < 600 && !std::filesystem::exists(file); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  REQUIRE(std::filesystem::exists(file));
  return nlohmann::json::parse(std::ifstream(file));
}

/// The pixels of a picture, each as large as the window shows it.
view::Picture enlarged(const view::Picture& picture) {
  view::Picture large{picture.width * scaled, picture.height * scaled, {}};
  for (std::uint32_t y = 0; y < large.height; ++y)
    for (std::uint32_t x = 0; x < large.width; ++x) {
      const std::size_t i = (std::size_t{y / scaled} * picture.width + x / scaled) * 4;
      large.bytes.insert(large.bytes.end(), picture.bytes.begin() + static_cast<std::ptrdiff_t>(i),
                         picture.bytes.begin() + static_cast<std::ptrdiff_t>(i + 4));
    }
  return large;
}

TEST_CASE("a person looks at a scene on two devices") {
  const ScratchFolder folder;
  const Screen screen(folder.path());
  const std::filesystem::path stem = folder.path() / "seen";
  Child viewer(fmt::format(
      "env DISPLAY={} LIBGL_ALWAYS_SOFTWARE=1 '{}' view {} --a cpu --b cpu-exact --size {}x{} --spp 4 --depth 3 "
      "--allow-outside-files -o '{}' 2> '{}/errors'",
      screen.display(), TANDEM_BINARY, box, width, height, stem.string(), folder.path().string()));
  const Hand hand(screen);
  const std::vector<std::string> finished = {"cpu 4 spp", "cpu-exact 4 spp", "pixels differ"};
  // The title may still be that of the view before, for as long as the window takes to see what a hand did.
  const auto settled = [&](std::string mode) {
    for (int i = 0; i < 20 && hand.title().find("cpu 4 spp") != std::string::npos; ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    std::vector<std::string> words = finished;
    words.push_back(std::move(mode));
    return hand.wait_for(words);
  };
  settled("split");
  const auto json = [&] { return saved(hand, stem.string() + ".json"); };
  const nlohmann::json first = json();

  hand.drag(1, 30, 10);
  settled("split");
  const nlohmann::json orbited = json();
  CHECK(orbited["camera"]["target"] == first["camera"]["target"]);
  CHECK(orbited["camera"]["position"] != first["camera"]["position"]);

  screen.hand("click 4");
  settled("split");
  const nlohmann::json nearer = json();
  CHECK(nearer["camera"]["target"] == first["camera"]["target"]);
  CHECK(nearer["camera"]["position"] != orbited["camera"]["position"]);

  hand.drag(1, 8, 4, "ctrl");
  settled("split");
  const nlohmann::json panned = json();
  CHECK(panned["camera"]["target"] != nearer["camera"]["target"]);

  hand.drag(1, 8, 4, "alt");
  settled("split");
  const nlohmann::json looked = json();
  CHECK(looked["camera"]["position"] == panned["camera"]["position"]);
  CHECK(looked["camera"]["target"] != panned["camera"]["target"]);

  hand.key("n");
  settled("split");
  hand.key("j");
  settled("split");
  const nlohmann::json lit = json();
  REQUIRE(lit["lights"].size() == 1);
  CHECK(lit["lights"][0]["type"] == "point");

  // What the window shows is what both devices render of the saved scene, left and right of the line.
  const std::string saved_scene = stem.string() + ".json";
  const std::string picture = (folder.path() / "rendered.png").string();
  std::vector<view::Picture> rendered;
  for (const char* device : {"cpu", "cpu-exact"}) {
    const Outcome outcome =
        run_tandem(words("render {} --device {} --allow-outside-files -o {}", {saved_scene, device, picture}));
    REQUIRE_MESSAGE(outcome.exit_code == 0, outcome.errors);
    rendered.push_back(enlarged(view::displayed(pathtracer::read_image(picture), {})));
  }
  const auto shown = [&] { return screen.part(left, top, width * scaled, height * scaled); };
  const auto shows = [&](const view::Picture& expected) {
    for (int i = 0; i < 100 && !(shown() == expected); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(50));
    return shown() == expected;
  };
  screen.hand("mousemove 480 470");  // the screen has the pointer in its pixels
  hand.key("1");
  settled("| a |");
  CHECK(shows(rendered[0]));
  hand.key("2");
  settled("| b |");
  CHECK(shows(rendered[1]));
  hand.key("3");
  settled("split");
  hand.key("6");
  settled("difference");

  // A click shows the path; it is on both devices, since they are both the CPU.
  hand.key("3");
  const view::Picture before = screen.part(0, 0, 490, 480);
  screen.hand(fmt::format("mousemove {} {} sleep 0.2 click 1", left + 10, top + 10));
  for (int i = 0; i < 600 && screen.part(0, 0, 490, 480) == before; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  CHECK(!(screen.part(0, 0, 490, 480) == before));
  hand.key("Escape");

  hand.key("F2");  // the device after cpu
  hand.wait_for({"| cpu-exact 4 spp | cpu-exact 4 spp |", "| 0 pixels differ"});
  hand.key("ctrl+q");
  CHECK(viewer.wait() == 0);
}

TEST_CASE("without a display there is one sentence") {
  const Outcome outcome = run_in_shell("unset DISPLAY WAYLAND_DISPLAY; tandem view " + box + " --size 8x8");
  CHECK(outcome.exit_code == 2);
  CHECK(outcome.errors.find("no window can be opened") != std::string::npos);
  CHECK(std::ranges::count(outcome.errors, '\n') == 1);
}

}  // namespace
}  // namespace tandem::test
