#include "tools/output/junit.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstddef>
#include <iterator>

#include "tools/output/xml_text.hpp"

namespace tandem::tools {

std::string junit_xml(const std::string& suite, std::span<const JunitCase> cases) {
  std::size_t failures = 0;
  std::size_t errors = 0;
  std::size_t skipped = 0;
  double seconds = 0;
  for (const JunitCase& each : cases) {
    errors += each.error.empty() ? 0 : 1;
    skipped += each.skipped.empty() ? 0 : 1;
    failures += each.error.empty() && !each.failures.empty() ? 1 : 0;
    seconds += each.seconds;
  }
  const std::string totals =
      fmt::format("name=\"{}\" tests=\"{}\" failures=\"{}\" errors=\"{}\"{} time=\"{:.3f}\"", xml_text(suite),
                  cases.size(), failures, errors, skipped == 0 ? "" : fmt::format(" skipped=\"{}\"", skipped), seconds);
  std::string text = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";
  fmt::format_to(std::back_inserter(text), "<testsuites {}>\n  <testsuite {}>\n", totals, totals);
  for (const JunitCase& each : cases) {
    fmt::format_to(std::back_inserter(text), "    <testcase classname=\"{}\" name=\"{}\" time=\"{:.3f}\"",
                   xml_text(each.group), xml_text(each.name), each.seconds);
    const auto add = [&](const char* element, const std::string& first, const std::string& all) {
      fmt::format_to(std::back_inserter(text), ">\n      <{0} message=\"{1}\">{2}</{0}>\n    </testcase>\n", element,
                     xml_text(first), xml_text(all));
    };
    if (!each.skipped.empty()) {
      fmt::format_to(std::back_inserter(text), ">\n      <skipped message=\"{}\"/>\n    </testcase>\n",
                     xml_text(each.skipped));
    } else if (!each.error.empty()) {
      add("error", each.error, each.error);
    } else if (!each.failures.empty()) {
      add("failure", each.failures.front(), fmt::format("{}", fmt::join(each.failures, "\n")));
    } else {
      text += "/>\n";
    }
  }
  return text + "  </testsuite>\n</testsuites>\n";
}

}  // namespace tandem::tools
