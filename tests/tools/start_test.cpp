#include <doctest/doctest.h>

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>
#include <string>
#include <string_view>

#include "pathtracer/image/image_io.hpp"
#include "tests/support/process.hpp"
#include "tests/support/scratch_folder.hpp"

// A program of its own, because what one test has loaded stays loaded for the others.

namespace tandem::test {
namespace {

/// A variable of the environment, for the programs that are started meanwhile too.
class Variable {
 public:
  Variable(const char* name, const char* value) : name_(name) { setenv(name, value, 1); }
  ~Variable() { unsetenv(name_); }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  const char* name_;
};

/// The libraries that the dynamic linker says it has loaded.
std::set<std::string> loaded_libraries(const std::string& trace) {
  constexpr std::string_view mark = "calling init: ";
  std::set<std::string> libraries;
  std::istringstream lines(trace);
  for (std::string line; std::getline(lines, line);)
    if (const std::size_t position = line.find(mark); position != std::string::npos)
      libraries.insert(line.substr(position + mark.size()));
  return libraries;
}

bool is_mapped(const std::string& name) {
  std::ifstream maps("/proc/self/maps");
  return std::string(std::istreambuf_iterator<char>(maps), {}).find(name) != std::string::npos;
}

std::ptrdiff_t thread_count() {
  return std::distance(std::filesystem::directory_iterator("/proc/self/task"), std::filesystem::directory_iterator());
}

TEST_CASE("the program starts with few libraries, none of them for pictures, compilers or drivers") {
  const Variable trace("LD_DEBUG", "files");
  const Outcome outcome = run_tandem({"--version"});
  CHECK(outcome.exit_code == 0);
  CHECK(outcome.output == "tandem " TANDEM_VERSION "\n");
  const std::set<std::string> libraries = loaded_libraries(outcome.errors);
  CAPTURE(outcome.errors);
  CHECK(libraries.size() >= 5);   // else the trace has not been understood
  CHECK(libraries.size() <= 20);  // 11 on Debian 12, and those of sanitizers
  for (const std::string& library : libraries)
    for (const char* heavy : {"OpenImageIO", "OpenEXR", "vulkan", "LLVM"})
      CHECK_MESSAGE(library.find(heavy) == std::string::npos, library);
}

TEST_CASE("the first picture loads what pictures need, and no earlier code starts a thread" *
          doctest::skip(!TANDEM_LOADS_IMAGE_LIBRARY)) {
  CHECK(!is_mapped("libOpenImageIO"));
  CHECK(thread_count() == 1);
  const ScratchFolder folder;
  pathtracer::Image image{2, 1, {glm::vec3(0.25f), glm::vec3(4)}};
  pathtracer::write_image(folder.path() / "a.exr", image, {});
  CHECK(is_mapped("libOpenImageIO"));
  CHECK(pathtracer::read_image(folder.path() / "a.exr").pixels == image.pixels);
}

TEST_CASE("without the library for pictures, rendering one is refused at once and in one sentence; the rest works" *
          doctest::skip(!TANDEM_LOADS_IMAGE_LIBRARY)) {
  const Variable missing("TANDEM_IMAGE_CODEC", "/nowhere/codec.so");
  const ScratchFolder folder;
  const std::string picture = (folder.path() / "a.png").string();
  const Outcome render =
      run_tandem({"render", TANDEM_SOURCE_DIRECTORY "/scenes/cornell_box.obj", "--device", "nothing", "-o", picture});
  CHECK(render.exit_code == 2);
  CHECK(render.output.empty());
  CHECK(render.errors.starts_with("tandem: cannot write '" + picture +
                                  "': the library for pictures cannot be loaded: "
                                  "/nowhere/codec.so: "));
  CHECK(std::count(render.errors.begin(), render.errors.end(), '\n') == 1);
  CHECK(folder.names().empty());
  CHECK(run_tandem({"generate", "--triangles", "1000", "-o", (folder.path() / "a.obj").string()}).exit_code == 0);
}

TEST_CASE("a library that is no codec is refused" * doctest::skip(!TANDEM_LOADS_IMAGE_LIBRARY)) {
  const Variable other("TANDEM_IMAGE_CODEC", "libm.so.6");
  const Outcome render = run_tandem({"render", TANDEM_SOURCE_DIRECTORY "/scenes/cornell_box.obj", "-o", "a.png"});
  CHECK(render.exit_code == 2);
  CHECK(render.errors.find("'libm.so.6' exports no tandem_image_codec") != std::string::npos);
}

}  // namespace
}  // namespace tandem::test
