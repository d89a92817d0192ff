#define DOCTEST_CONFIG_IMPLEMENT
#include <doctest/doctest.h>

#include <cstdlib>
#include <iostream>
#include <string>
#include <vector>

#include "tests/support/device_test.hpp"
#include "tests/support/run_summary.hpp"

namespace tandem::test {
namespace {

/// CTest's SKIP_RETURN_CODE: all cases that were to run were skipped.
constexpr int skipped_exit_code = 77;

/// Tells the summary which case runs.
struct SummaryListener : doctest::IReporter {
  explicit SummaryListener(const doctest::ContextOptions&) {}
  void test_case_start(const doctest::TestCaseData& data) override { summary.started(data.m_name); }
  void test_case_end(const doctest::CurrentTestCaseStats&) override { summary.ended(); }
  void test_case_skipped(const doctest::TestCaseData& data) override { summary.filtered_out(data.m_name); }

  void report_query(const doctest::QueryData&) override {}
  void test_run_start() override {}
  void test_run_end(const doctest::TestRunStats&) override {}
  void test_case_reenter(const doctest::TestCaseData&) override {}
  void test_case_exception(const doctest::TestCaseException&) override {}
  void subcase_start(const doctest::SubcaseSignature&) override {}
  void subcase_end() override {}
  void log_assert(const doctest::AssertData&) override {}
  void log_message(const doctest::MessageData&) override {}

  RunSummary& summary = RunSummary::of_this_run();
};
REGISTER_LISTENER("summary", 1, SummaryListener);

/// The exit code of the run; prints what is wrong beside failed cases.
int run(int argument_count, char** arguments) {
  int result = doctest::Context(argument_count, arguments).run();
  const auto fail = [&result](const std::string& sentence) {
    std::cerr << sentence << '\n';
    result = EXIT_FAILURE;
  };
  for (const std::string& warning : release_devices()) fail("while the devices were destroyed: " + warning);
  const RunSummary& summary = RunSummary::of_this_run();
  std::cout << summary.skips();
  for (const std::string& sentence : summary.idle_devices(device_names())) fail(sentence);
  return result == EXIT_SUCCESS && summary.skipped_all() ? skipped_exit_code : result;
}

}  // namespace
}  // namespace tandem::test

int main(int argument_count, char** arguments) { return tandem::test::run(argument_count, arguments); }
