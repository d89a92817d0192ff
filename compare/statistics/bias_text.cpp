#include "compare/statistics/bias_text.hpp"

#include <fmt/format.h>

namespace tandem::compare {

std::string text_of(const Tile& tile) {
  return fmt::format("the {}x{} pixels from {},{} on", tile.width, tile.height, tile.left, tile.top);
}

namespace {

std::string text_of(const statistics::Mean& mean) {
  return fmt::format("{:.5g} +- {:.2g}", mean.value, mean.standard_error);
}

}  // namespace

std::string text_of(const ComparedMean& mean, const std::string& a, const std::string& b) {
  return fmt::format("{} has {}, {} {} ({:+.3g} %)", a, text_of(mean.a), b, text_of(mean.b),
                     100 * mean.relative_difference());
}

}  // namespace tandem::compare
