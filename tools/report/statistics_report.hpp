#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "compare/statistics/bias_test.hpp"
#include "compare/verdict/verdict.hpp"

namespace tandem::tools {

/// What tier statistical found out.
struct Statistics {
  double level = 0;  ///< p-values below this are a bias
  std::uint32_t batches = 0;
  std::uint32_t batch_samples = 0;  ///< per pixel
  std::uint32_t tile = 0;           ///< side in pixels
  /// Seeds of the first batches; the others follow.
  std::uint32_t seed_a = 0, control_seed_a = 0, seed_b = 0, control_seed_b = 0;
  compare::BiasTest bias = {};       ///< a against b
  compare::BiasTest control_a = {};  ///< a against itself under other seeds: the noise floor
  compare::BiasTest control_b = {};  ///< b likewise
  compare::BiasPower power = {};     ///< of the test of a against b
};

/// What a verdict asks for.
std::vector<compare::BiasFinding> bias_findings(const Statistics& statistics);

/// For people.
std::string table(const Statistics& statistics);

/// For programs; docs/guide/user-guide.md lists the keys.
nlohmann::ordered_json to_json(const Statistics& statistics);

}  // namespace tandem::tools
