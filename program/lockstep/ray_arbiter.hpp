#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "program/execute/execution.hpp"
#include "program/lockstep/walk.hpp"
#include "rhi/device.hpp"

namespace tandem::program {

struct Divergence;

/// Decides between two answers to a ray: it is traced once more on a device that does not round, and so are its
/// neighbours, which differ from it by a few units in the last place. What one of them meets, a device may answer.
class RayArbiter {
 public:
  /// @param exact a device with ray queries that does not round; @param job whose only pipeline traces the rays. Both
  /// outlive the arbiter.
  RayArbiter(rhi::Device& exact, const Job& job);
  ~RayArbiter();

  /// About what a ray query or a hit shader's built-in says of a committed hit: a tie, within precision or a mismatch.
  /// Nothing for any other instruction, and where the ray is not known.
  std::optional<Judgement> judge(const Walk& walk, const Divergence& difference) const;

 private:
  struct Ray;
  struct Answer;
  struct Tracer;

  std::optional<Ray> ray_of(const RecordedShader& shader, const OperandValues& operands) const;
  /// Of the ray and its neighbours. Where a shader is shown candidates, all of them are answers.
  std::vector<Answer> answers(const Ray& ray) const;
  bool shows_candidates(const Ray& ray) const;
  std::optional<std::size_t> top_level_of(const Module& module, std::uint32_t structure) const;
  float extent() const;

  rhi::Device& exact_;
  const Job& job_;
  float extent_ = 1;             ///< the largest coordinate of the scene
  bool has_candidates_ = false;  ///< unless a ray's flags say otherwise
  bool has_boxes_ = false;       ///< that an intersection shader, or a query, decides about
  mutable std::map<std::size_t, std::unique_ptr<Tracer>> tracers_;  ///< by top level, each made once it is needed
};

}  // namespace tandem::program
