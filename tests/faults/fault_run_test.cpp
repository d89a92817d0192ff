#include "tests/faults/fault_run.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "devices/devices.hpp"
#include "tests/faults/fault_table.hpp"

using namespace tandem;
using namespace tandem::test;

namespace {

/// One that needs no shader to be compiled.
Fault fault_named(const std::string& name) {
  const std::vector<Fault> all = all_faults();
  const auto found = std::ranges::find(all, name, &Fault::name);
  REQUIRE(found != all.end());
  return *found;
}

}  // namespace

TEST_CASE("What is found of a fault is held against what it declares") {
  FaultRunner runner(create_device({.name = "cpu"}), create_device({.name = "cpu-exact"}));
  const Fault as_declared = fault_named("last-instance-lost");
  CHECK(runner.run(as_declared).problem == "");

  Fault harmless = as_declared;
  harmless.harmful = false;
  CHECK(runner.run(harmless).problem == "a mismatch, by picture: ray answer");
  Fault elsewhere = as_declared;
  elsewhere.event = "surface";
  CHECK(runner.run(elsewhere).problem == "the event is 'ray' and not 'surface'");
  Fault other_field = as_declared;
  other_field.fields = {"t"};
  CHECK(runner.run(other_field).problem == "the field is 'answer' and not 't'");
  Fault later = as_declared;
  later.segment = 2;
  CHECK(runner.run(later).problem == "the first segment is 0 and not 2");
  Fault unseen = as_declared;
  unseen.finder = Finder::survey;
  CHECK(runner.run(unseen).problem == "found by picture and not by survey");

  Fault none = fault_named("none");
  CHECK(runner.run(none).problem == "");
  none.harmful = true;
  CHECK(runner.run(none).problem == "no mismatch");
}

TEST_CASE("The tables say of each fault whether it was found as declared") {
  Fault fault;
  fault.name = "mask-ignored";
  fault.meaning = "a ray meets everything";
  fault.scene = "a.obj";
  Finding right;
  right.found_by = Finder::picture;
  right.worst = compare::DifferenceClass::mismatch;
  right.event = "ray";
  right.field = "answer";
  right.segment = 3;
  Finding wrong = right;
  wrong.problem = "too late";
  const std::vector<FaultRow> rows = {{fault, right}, {fault, wrong}};
  CHECK(summary(rows) ==
        "1 of 2 harmful faults are detected, in the right class, bounce and field; 0 of 0 harmless faults and 0 of 0 "
        "unmodified controls are accepted");
  CHECK(text_table(rows) ==
        "fault         scene  found by  class     bounce  where        as declared\n"
        "mask-ignored  a.obj  picture   mismatch  3       ray: answer  yes\n"
        "mask-ignored  a.obj  picture   mismatch  3       ray: answer  NO: too late\n");
  CHECK(markdown_page(rows).find("| mask-ignored | a ray meets everything | a.obj | picture | mismatch | 3 | "
                                 "ray: answer (NO: too late) |\n") != std::string::npos);
  const nlohmann::ordered_json json = to_json(rows);
  CHECK(json["faults"][0]["ok"] == true);
  CHECK(json["faults"][0]["bounce"] == 3);
  CHECK(json["faults"][1]["problem"] == "too late");
}
