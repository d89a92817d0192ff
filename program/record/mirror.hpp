#pragma once

#include <cstdint>
#include <unordered_map>

#include "program/record/code.hpp"

namespace tandem::program {

/// Lets the invocations of a launch do each other's work: the first does that of the last, and so on. What a shader
/// computes stays the same unless it depends on the order in which invocations run, and a device that runs them in
/// order runs them backwards so. Where a shader has subgroup operations, the workgroups are mirrored, and their
/// invocations are not: who belongs to a subgroup stays.
class Mirror {
 public:
  /// @param model GLCompute, or a stage of a ray tracing pipeline
  Mirror(const Module& module, Globals& globals, spv::ExecutionModel model);

  /// The variable that stands for an input of the module; the id itself for any other.
  std::uint32_t in_place_of(std::uint32_t id) const;
  bool replaces(std::uint32_t id) const { return variables_.contains(id); }

  /// At the beginning of the entry point: gives the variables their values.
  void begin_entry(Code& code);

 private:
  std::uint32_t workgroup_size(const Module& module, Globals& globals) const;
  void add(const Module& module, Globals& globals, spv::BuiltIn built_in, bool is_needed);

  bool is_compute_, keeps_workgroups_ = false;
  std::unordered_map<std::uint32_t, std::uint32_t> variables_;  ///< by the input's id
  std::unordered_map<std::uint32_t, spv::BuiltIn> built_ins_;   ///< likewise
  std::uint32_t size_ = 0;                                      ///< of a workgroup: a constant vector
  std::uint32_t counts_ = 0;                                    ///< the input NumWorkgroups, or LaunchSize
};

}  // namespace tandem::program
