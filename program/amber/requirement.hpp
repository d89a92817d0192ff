#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "program/amber/position.hpp"
#include "rhi/device.hpp"

namespace tandem::program::amber {

/// What a script asks of the device before anything of it runs.
struct Requirement {
  enum class Kind : std::uint8_t { feature, property, device_extension, instance_extension };

  Kind kind = Kind::feature;
  std::string name;
  Position position;
};

/// Whether Amber's language knows a feature or property of this name. Extensions are not listed.
bool is_known(Requirement::Kind kind, std::string_view name);

/// The first that the device lacks, as "it needs the device feature shaderFloat64"; "" when it has all.
std::string missing(std::span<const Requirement> requirements, const rhi::DeviceInfo& device);

}  // namespace tandem::program::amber
