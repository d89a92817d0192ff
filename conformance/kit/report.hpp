#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>

#include "conformance/kit/run.hpp"

/// What a run says: the same reports give the same text.
namespace tandem::conformance {

/// For a terminal: counts by group, then every result that is neither passed nor unsupported with its sentence, what is
/// unsupported and why, and the notes.
std::string text(const DeviceReport& report);

/// Everything: device, counts and all results.
nlohmann::ordered_json to_json(std::span<const DeviceReport> reports);

/// docs/results/backend-status.md: a table of groups by devices, the driver bugs, what is unsupported and the notes,
/// then catalogue().
std::string markdown(std::span<const DeviceReport> reports, std::span<const Case> cases,
                     std::span<const DriverBug> driver_bugs);

/// The part of markdown() that no device has a say in: the known driver bugs and what each case is about.
std::string catalogue(std::span<const Case> cases, std::span<const DriverBug> driver_bugs);

}  // namespace tandem::conformance
