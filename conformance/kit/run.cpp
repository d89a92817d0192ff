#include "conformance/kit/run.hpp"

#include <algorithm>
#include <exception>

#include "conformance/kit/check.hpp"

namespace tandem::conformance {
namespace {

/// Runs the body and says how it ended, regardless of known bugs.
Result run_body(const Case& test, Context& context, const RunOptions& options) {
  Result result = {.name = test.name};
  const rhi::Capabilities& capabilities = context.device().info().capabilities;
  for (const Capability needed : test.needs) {
    if (capabilities.*needed) continue;
    result.status = Status::unsupported;
    result.sentence = fmt::format("the device lacks {}", name_of(needed));
    return result;
  }
  const auto end = [&result](Status status, const std::exception& exception) {
    result.status = status;
    result.sentence = exception.what();
  };
  try {
    test.run(context);
    context.device().wait_idle();
  } catch (const Failure& failure) {
    end(Status::failed, failure);
  } catch (const Unsupported& unsupported) {
    end(Status::unsupported, unsupported);
  } catch (const std::exception& error) {
    end(Status::error, error);
  }
  result.note = context.take_note();
  if (!options.take_messages) return result;
  const std::vector<std::string> messages = options.take_messages();
  if (!messages.empty() && result.status != Status::error) {
    result.status = Status::failed;
    result.sentence += (result.sentence.empty() ? "" : "; ") + fmt::format("the device said: {}", messages.front());
  }
  return result;
}

void compare_with_known_bug(Result& result, const DriverBug& bug, const std::string& driver) {
  const bool wrong = result.status == Status::failed || result.status == Status::error;
  if (wrong && result.sentence.find(bug.failure) != std::string::npos) {
    result.status = Status::driver_bug;
  } else if (wrong) {
    result.sentence += fmt::format(" (the known driver bug says '{}')", bug.failure);
  } else if (result.status == Status::passed && is_seen_version(bug, driver)) {
    result.status = Status::unexpected_pass;
    result.sentence = fmt::format("passes, but is listed as a bug of {} {}: {}", bug.driver, bug.version, bug.reason);
  }
}

}  // namespace

std::string_view name_of(Status status) {
  switch (status) {
    case Status::passed:
      return "passed";
    case Status::failed:
      return "failed";
    case Status::error:
      return "error";
    case Status::driver_bug:
      return "driver bug";
    case Status::unexpected_pass:
      return "unexpected pass";
    case Status::unsupported:
      return "unsupported";
  }
  return "unknown";
}

DeviceReport run(rhi::Device& device, std::span<const Case> cases, const RunOptions& options) {
  DeviceReport report = {.device = device.info()};
  Context context(device, options.settings);
  for (const Case& test : cases) {
    Result result = run_body(test, context, options);
    const DriverBug* const bug = find_driver_bug(options.driver_bugs, report.device.driver, test.name);
    if (bug != nullptr) compare_with_known_bug(result, *bug, report.device.driver);
    report.results.push_back(std::move(result));
    if (options.on_result) options.on_result(report.results.back());
  }
  return report;
}

std::size_t count(const DeviceReport& report, Status status) {
  return static_cast<std::size_t>(std::count_if(report.results.begin(), report.results.end(),
                                                [status](const Result& result) { return result.status == status; }));
}

bool succeeded(const DeviceReport& report) {
  return count(report, Status::failed) == 0 && count(report, Status::error) == 0 &&
         count(report, Status::unexpected_pass) == 0 && count(report, Status::passed) > 0;
}

}  // namespace tandem::conformance
