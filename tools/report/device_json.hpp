#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

#include "rhi/device.hpp"

namespace tandem::tools {

/// "format" of every JSON file that a command writes. It grows when a key changes its name, type or meaning, or goes;
/// new keys may come without (docs/schema).
inline constexpr int json_format = 1;

/// name, backend, description, driver, api and kind.
nlohmann::ordered_json to_json(const rhi::DeviceInfo& device);

/// to_json with capabilities and limits.
nlohmann::ordered_json to_json_in_full(const rhi::DeviceInfo& device);

/// 2^32 - 1 is null: no distance between values that are no floats, no primitive that a ray meets.
nlohmann::ordered_json number_or_null(std::uint32_t value);

/// "discrete GPU", "CPU", ...
const char* kind_name(rhi::DeviceKind kind);

/// The text of a JSON file. Bytes that are no UTF-8 (a file name may hold any) are replaced.
std::string json_text(const nlohmann::ordered_json& value);

}  // namespace tandem::tools
