#pragma once

#include <span>
#include <string>
#include <vector>

/// Results as JUnit XML, which CI servers read.
namespace tandem::tools {

/// One comparison.
struct JunitCase {
  std::string group;                  ///< "classname": the scene
  std::string name;                   ///< the devices and the settings
  double seconds = 0;                 ///< that it took
  std::vector<std::string> failures;  ///< the sentences of the verdict; empty: it passed
  std::string error;                  ///< why there is no verdict; empty: there is one
  std::string skipped = {};           ///< why it was not tried; empty: it was
};

/// A <testsuites> of one <testsuite>. What XML cannot hold (control characters, bytes that are no UTF-8) becomes
/// U+FFFD.
std::string junit_xml(const std::string& suite, std::span<const JunitCase> cases);

}  // namespace tandem::tools
