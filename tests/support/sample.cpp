// A test program whose cases fail, skip or cause a warning where the environment says so: run_test.cpp runs it.

#include <doctest/doctest.h>

#include <cstdlib>
#include <stdexcept>
#include <string>

#include "tests/support/device_test.hpp"
#include "tests/support/run_summary.hpp"

using namespace tandem;

namespace {

bool is_set(const char* variable, const std::string& device) {
  const char* const value = std::getenv(variable);
  return value != nullptr && value == device;
}

}  // namespace

TANDEM_DEVICE_TEST("first") {
  if (is_set("SAMPLE_SKIPS", device_name)) TANDEM_SKIP("the sample was told to");
  if (is_set("SAMPLE_WARNS", device_name)) {
    // The CPU says so where it compiles a shader and cannot use the kernel cache.
    test::compute_pipeline(device, "#version 460\nlayout(local_size_x = 1) in;\nvoid main() {}\n", "nothing");
  }
  REQUIRE_FALSE(is_set("SAMPLE_FAILS", device_name));
  if (is_set("SAMPLE_THROWS", device_name)) throw std::runtime_error("the sample was told to throw");
  CHECK(&device == device_handle.get());
}

TANDEM_DEVICE_TEST("second") {
  if (is_set("SAMPLE_SKIPS", device_name)) TANDEM_SKIP("the sample was told to");
  CHECK(device.info().name == device_name);
}

TEST_CASE("a case of no device") { CHECK(true); }
