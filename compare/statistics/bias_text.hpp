#pragma once

#include <string>

#include "compare/statistics/bias_test.hpp"

namespace tandem::compare {

/// "the 16x16 pixels from 32,48 on"
std::string text_of(const Tile& tile);

/// "a has 0.2 +- 0.01, b 0.3 +- 0.01 (+50 %)"
std::string text_of(const ComparedMean& mean, const std::string& a, const std::string& b);

}  // namespace tandem::compare
