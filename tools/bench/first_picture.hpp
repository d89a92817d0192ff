#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "tools/bench/plan.hpp"

namespace tandem::tools {

/// Milliseconds in which a program of its own ('tandem render', of the configuration with one sample per pixel) goes
/// from its start to a picture in a file. Nothing where that takes longer than `limit`: the program is then ended.
/// Throws Error where it fails, with the sentence that it ended with, and Cancelled.
std::optional<double> first_picture(const Configuration& configuration, const std::string& device,
                                    std::chrono::milliseconds limit);

}  // namespace tandem::tools
