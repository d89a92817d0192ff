#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "rhi/acceleration_structure.hpp"

/// Rules of acceleration structures that depend on what was built when a command executes. A backend calls them for the
/// commands of a list in their order. Each throws Error(invalid_argument).
namespace tandem::rhi::validation {

/// Of a structure in a bind group of a dispatch or a trace.
/// @param pipeline label of the pipeline that uses it
void check_traced(const AccelerationStructure& structure, bool is_built, const std::string& pipeline);

/// @param built instances of its last build (a bottom level: 0); nothing when there was none
void check_updated(const AccelerationStructure& structure, std::optional<std::uint32_t> built,
                   std::uint32_t instance_count);

/// @param label of the copy
void check_compacted(const AccelerationStructure& source, bool is_built, const std::string& label);

/// Of a structure that is to be built, not updated.
void check_room(const AccelerationStructure& structure, bool is_compacted_copy);

}  // namespace tandem::rhi::validation
