#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "conformance/kit/context.hpp"
#include "rhi/device.hpp"

/// The conformance kit: one test body per behaviour of the rhi, run on any rhi::Device. It knows no backend.
namespace tandem::conformance {

/// A bit of rhi::Capabilities that a case cannot run without.
using Capability = bool rhi::Capabilities::*;

/// The capability's name in rhi::Capabilities, "ray_query" for example.
std::string_view name_of(Capability capability);

/// One behaviour.
struct Case {
  std::string name;                   ///< group.subgroup.behaviour, in lower case; groups are named as in VK-GL-CTS
  std::string behaviour;              ///< what must be true, in one sentence without a full stop
  std::vector<Capability> needs;      ///< without one of them the case is unsupported and does not run
  std::function<void(Context&)> run;  ///< throws Failure, Unsupported, or an rhi::Error of what it calls
};

/// The name up to the last dot: group.subgroup.
std::string_view group_of(std::string_view case_name);

/// Every case of the kit, group by group. Names are unique.
std::vector<Case> all_cases();

}  // namespace tandem::conformance
