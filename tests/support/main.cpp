#define DOCTEST_CONFIG_IMPLEMENT
#include <doctest/doctest.h>

#include <cstdlib>
#include <iostream>
#include <string>
#include <vector>

#include "tests/support/device_test.hpp"

int main(int argument_count, char** arguments) {
  const int result = doctest::Context(argument_count, arguments).run();
  const std::vector<std::string> warnings = tandem::test::release_devices();
  for (const std::string& warning : warnings) std::cerr << "while the devices were destroyed: " << warning << '\n';
  return result != EXIT_SUCCESS || warnings.empty() ? result : EXIT_FAILURE;
}
