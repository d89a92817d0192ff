// docs/schema/devices.schema.json against what 'tandem devices --json' prints.

#include <doctest/doctest.h>

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "tests/pathtracer/load/description/json_schema.hpp"
#include "tests/support/process.hpp"
#include "tests/support/scratch_folder.hpp"

namespace tandem::test {
namespace {

using Json = nlohmann::json;

TEST_CASE("the schema accepts what 'tandem devices --json' prints, and describes every member") {
  const JsonSchema schema(Json::parse(read_text(TANDEM_SOURCE_DIRECTORY "/docs/schema/devices.schema.json")));
  const Outcome outcome = run_tandem({"devices", "--json"}, {});
  REQUIRE(outcome.exit_code == 0);
  const Json devices = Json::parse(outcome.output);
  CHECK(schema.accepts(devices));
  const Json& described = schema.root().at("items").at("properties");
  REQUIRE(!devices.empty());
  for (const Json& device : devices) {
    for (const auto& [member, value] : device.items()) CHECK_MESSAGE(described.contains(member), member);
    for (const char* part : {"capabilities", "limits"})
      for (const auto& [member, value] : device.at(part).items())
        CHECK_MESSAGE(described.at(part).at("properties").contains(member), member);
  }
}

}  // namespace
}  // namespace tandem::test
