#include <doctest/doctest.h>

#include <filesystem>
#include <pugixml.hpp>
#include <string>

#include "tests/support/process.hpp"
#include "tests/support/scratch_folder.hpp"

namespace tandem::test {
namespace {

const std::string good =
    "#!amber\nBUFFER a DATA_TYPE int32 DATA 1 2 END\nBUFFER b DATA_TYPE int32 DATA 1 2 END\nEXPECT a EQ_BUFFER b\n";
const std::string bad = good + "EXPECT a IDX 4 EQ 3\n";

TEST_CASE("amber: the exit code is that of the worst script, and each has a line") {
  const ScratchFolder folder;
  folder.write("good.amber", good);
  folder.write("bad.amber", bad);
  folder.write("graphics.amber", "#!amber\nPIPELINE graphics p\nEND\n");
  folder.write("wrong.amber", "#!amber\nBUFFER a DATA_TYPE int33 DATA 1 END\n");
  const auto run = [&](const std::string& line) { return run_tandem("amber " + line, {.folder = folder.path()}); };

  const Outcome passed = run("good.amber graphics.amber --device cpu,cpu-scalar");
  CHECK(passed.exit_code == 0);
  CHECK(passed.output ==
        "passed   cpu        good.amber\n"
        "passed   cpu-scalar good.amber\n"
        "skipped  cpu        graphics.amber: a graphics pipeline (line 2)\n"
        "skipped  cpu-scalar graphics.amber: a graphics pipeline (line 2)\n"
        "cpu: 2 scripts, 1 passed, 0 failed, 1 skipped, 0 with an error\n"
        "cpu-scalar: 2 scripts, 1 passed, 0 failed, 1 skipped, 0 with an error\n");

  const Outcome failed = run("bad.amber good.amber");
  CHECK(failed.exit_code == 1);
  CHECK(failed.output.find("failed   cpu        bad.amber\n         line 5: a is 2 at byte 4, expected 3\n") !=
        std::string::npos);

  const Outcome wrong = run("wrong.amber bad.amber");
  CHECK(wrong.exit_code == 2);
  CHECK(wrong.output.find("error    cpu        wrong.amber\n         wrong.amber:2:20: 'int33' is no type\n") !=
        std::string::npos);
  CHECK(run("absent.amber").exit_code == 2);
  CHECK(run("good.amber --device nonsense").exit_code == 2);
}

TEST_CASE("amber: a folder is the scripts in it, and JUnit has a case for each") {
  const ScratchFolder folder;
  std::filesystem::create_directories(folder.path() / "scripts/more");
  std::filesystem::create_directories(folder.path() / "empty");
  folder.write("scripts/more/good.amber", good);
  folder.write("scripts/bad.amber", bad);
  folder.write("scripts/graphics.amber", "#!amber\nPIPELINE graphics p\nEND\n");
  folder.write("scripts/readme.txt", "nothing");
  const Outcome outcome = run_tandem("amber scripts --junit out.xml", {.folder = folder.path()});
  CHECK(outcome.exit_code == 1);
  pugi::xml_document document;
  REQUIRE(document.load_file((folder.path() / "out.xml").c_str()));
  const pugi::xml_node suite = document.child("testsuites").child("testsuite");
  CHECK(suite.attribute("tests").as_int() == 3);
  CHECK(suite.attribute("failures").as_int() == 1);
  CHECK(suite.attribute("skipped").as_int() == 1);
  CHECK(std::string(suite.child("testcase").attribute("classname").value()) == "scripts/bad.amber");
  CHECK(std::string(suite.child("testcase").child("failure").attribute("message").value()) ==
        "line 5: a is 2 at byte 4, expected 3");

  folder.write("empty/readme.txt", "nothing");
  CHECK(run_tandem("amber empty", {.folder = folder.path()}).errors ==
        "tandem: empty: the folder has no file .amber\n");
}

}  // namespace
}  // namespace tandem::test
