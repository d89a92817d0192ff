#include "tests/support/run_summary.hpp"

#include <algorithm>

namespace tandem::test {

RunSummary& RunSummary::of_this_run() {
  static RunSummary summary;
  return summary;
}

void RunSummary::add_device_case(const char* name, std::size_t device_index) {
  device_cases_[name] = device_index;
  ++devices_[device_index].registered;
}

RunSummary::DeviceCount* RunSummary::device_of(const char* name) {
  const auto found = device_cases_.find(name);
  return found == device_cases_.end() ? nullptr : &devices_.at(found->second);
}

void RunSummary::filtered_out(const char* name) {
  if (DeviceCount* const device = device_of(name)) ++device->filtered_out;
}

void RunSummary::started(const char* name) {
  current_ = name;
  current_is_skipped_ = false;
  any_started_ = true;
}

void RunSummary::skip(const std::string& reason) {
  if (current_ == nullptr) return;
  current_is_skipped_ = true;
  std::vector<std::string>& cases = skipped_[reason];
  if (std::ranges::find(cases, current_) == cases.end()) cases.emplace_back(current_);
}

void RunSummary::ended() {
  if (!current_is_skipped_) {
    ++executed_;
    if (DeviceCount* const device = device_of(current_)) ++device->executed;
  }
  current_ = nullptr;
}

std::string RunSummary::skips() const {
  std::string text;
  for (const auto& [reason, cases] : skipped_) {
    text += std::to_string(cases.size()) + " skipped: " + reason + '\n';
    for (const std::string& name : cases) text += "  " + name + '\n';
  }
  return text;
}

std::vector<std::string> RunSummary::idle_devices(const std::vector<std::string>& names) const {
  std::vector<std::string> sentences;
  if (!any_started_) return sentences;  // cases were only listed or counted
  for (const auto& [index, device] : devices_) {
    if (device.filtered_out != 0 || device.executed != 0) continue;
    sentences.push_back("Device " + names[index] + " ran none of its " + std::to_string(device.registered) +
                        " test cases.");
  }
  return sentences;
}

}  // namespace tandem::test
