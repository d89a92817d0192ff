#include "rhi/validation/built.hpp"

#include "rhi/validation/require.hpp"

namespace tandem::rhi::validation {

using std::to_string;

void check_traced(const AccelerationStructure& structure, bool is_built, const std::string& pipeline) {
  require(is_built, structure.label(), "the pipeline '" + pipeline + "' traces it before it is built");
}

void check_updated(const AccelerationStructure& structure, std::optional<std::uint32_t> built,
                   std::uint32_t instance_count) {
  require(built.has_value(), structure.label(), "it is updated, but was never built");
  require(*built == instance_count, structure.label(),
          "an update with " + to_string(instance_count) + " instances of a structure built with " + to_string(*built));
}

void check_compacted(const AccelerationStructure& source, bool is_built, const std::string& label) {
  require(is_built, label, "the structure '" + source.label() + "', to be compacted, was never built");
}

void check_room(const AccelerationStructure& structure, bool is_compacted_copy) {
  require(!is_compacted_copy, structure.label(), "a compacted copy has no room for a build, only for an update");
}

}  // namespace tandem::rhi::validation
