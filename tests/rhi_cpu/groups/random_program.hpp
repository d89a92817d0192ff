#pragma once

#include <cstdint>
#include <memory>
#include <random>
#include <string>
#include <vector>

/// Programs with branches, loops, switches, calls and returns that differ from lane to lane, as GLSL and as what their
/// lanes compute when they reconverge as early as the control flow's structure allows
/// (VK_KHR_shader_maximal_reconvergence).
namespace tandem::cpu::test {

class RandomProgram {
 public:
  /// @param seed of std::mt19937
  RandomProgram(std::uint32_t seed, std::uint32_t function_count);

  /// Functions `uint program(uint lane)`, which mixes each ballot of its active lanes into its result, and those that
  /// it calls. Names begin with `name`.
  std::string glsl(const std::string& name) const;

  /// The results of the lanes [0, count) of one subgroup. `first` is added to a lane's number to get its `lane`.
  std::vector<std::uint32_t> results(std::uint32_t count, std::uint32_t first) const;

  struct Node;
  using Block = std::vector<std::shared_ptr<const Node>>;

 private:
  std::vector<Block> functions_;  ///< each calls only those before it
};

}  // namespace tandem::cpu::test
