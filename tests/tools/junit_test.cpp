#include "tools/output/junit.hpp"

#include <doctest/doctest.h>

#include <pugixml.hpp>
#include <string>
#include <vector>

#include "tests/support/process.hpp"
#include "tests/support/scratch_folder.hpp"

namespace tandem::tools {
namespace {

pugi::xml_document parse(const std::string& text) {
  pugi::xml_document document;
  const pugi::xml_parse_result result =
      document.load_buffer(text.data(), text.size(), pugi::parse_default | pugi::parse_ws_pcdata, pugi::encoding_utf8);
  CAPTURE(text);
  REQUIRE_MESSAGE(result, result.description());
  return document;
}

TEST_CASE("JUnit counts what passed, failed and could not be done") {
  const std::vector<JunitCase> cases = {
      {.group = "box.obj", .name = "good", .seconds = 1.5, .failures = {}, .error = {}},
      {.group = "box.obj", .name = "bad", .seconds = 0.25, .failures = {"First.", "Second."}, .error = {}},
      {.group = "knot.obj", .name = "gone", .seconds = 0, .failures = {}, .error = "no such device"}};
  const pugi::xml_document document = parse(junit_xml("suite", cases));
  const pugi::xml_node suite = document.child("testsuites").child("testsuite");
  CHECK(std::string(suite.attribute("name").value()) == "suite");
  CHECK(suite.attribute("tests").as_int() == 3);
  CHECK(suite.attribute("failures").as_int() == 1);
  CHECK(suite.attribute("errors").as_int() == 1);
  CHECK(suite.attribute("time").as_double() == 1.75);
  std::vector<pugi::xml_node> nodes;
  for (const pugi::xml_node& node : suite.children("testcase")) nodes.push_back(node);
  REQUIRE(nodes.size() == 3);
  CHECK(std::string(nodes[0].attribute("classname").value()) == "box.obj");
  CHECK(std::string(nodes[0].attribute("name").value()) == "good");
  CHECK(nodes[0].attribute("time").as_double() == 1.5);
  CHECK(nodes[0].first_child().empty());
  CHECK(std::string(nodes[1].child("failure").attribute("message").value()) == "First.");
  CHECK(std::string(nodes[1].child("failure").text().get()) == "First.\nSecond.");
  CHECK(std::string(nodes[2].child("error").text().get()) == "no such device");
}

TEST_CASE("JUnit says what was skipped") {
  const std::vector<JunitCase> cases = {
      {.group = "a.amber", .name = "cpu", .seconds = 0, .failures = {}, .error = {}, .skipped = "a graphics pipeline"},
      {.group = "b.amber", .name = "cpu", .seconds = 0, .failures = {}, .error = {}}};
  const pugi::xml_document document = parse(junit_xml("amber", cases));
  const pugi::xml_node suite = document.child("testsuites").child("testsuite");
  CHECK(suite.attribute("skipped").as_int() == 1);
  CHECK(suite.attribute("failures").as_int() == 0);
  const pugi::xml_node skipped = suite.child("testcase").child("skipped");
  CHECK(std::string(skipped.attribute("message").value()) == "a graphics pipeline");
}

TEST_CASE("JUnit keeps any text that XML can hold, and marks what it cannot") {
  const std::string held = "<a href='x'>&amp; \"quoted\" ]]> \t\n\r\xc3\xa4 \xe2\x82\xac \xf0\x9f\x98\x80";
  // A control character, half a character, a surrogate, an overlong slash, a continuation without a beginning.
  const std::string unheld = "\x01 \xc3 \xed\xa0\x80 \xc0\xaf \xbf";
  const auto read = [](const std::string& text) {
    const std::vector<JunitCase> cases = {{.group = text, .name = "x", .seconds = 0, .failures = {text}, .error = {}}};
    const pugi::xml_document document = parse(junit_xml("suite", cases));
    const pugi::xml_node node = document.child("testsuites").child("testsuite").child("testcase");
    CHECK(std::string(node.attribute("classname").value()) == node.child("failure").text().get());
    return std::string(node.child("failure").text().get());
  };
  CHECK(read(held) == held);
  const std::string mark = "\xef\xbf\xbd";
  CHECK(read(unheld) == mark + " " + mark + " " + mark + mark + mark + " " + mark + mark + " " + mark);
}

TEST_CASE("diff writes its verdict as JUnit") {
  const test::ScratchFolder folder;
  const test::Outcome outcome = test::run_tandem(test::words("diff {} --a cpu --b cpu --size 8x8 --spp 1 --junit x.xml",
                                                             {TANDEM_SOURCE_DIRECTORY "/scenes/cornell_box.obj"}),
                                                 {.folder = folder.path()});
  CHECK(outcome.exit_code == 0);
  const pugi::xml_document document = parse(test::read_text(folder.path() / "x.xml"));
  const pugi::xml_node node = document.child("testsuites").child("testsuite").child("testcase");
  CHECK(std::string(node.attribute("name").value()) == "cpu against cpu");
  CHECK(std::string(node.attribute("classname").value()).ends_with("cornell_box.obj"));
  CHECK(node.first_child().empty());
}

}  // namespace
}  // namespace tandem::tools
