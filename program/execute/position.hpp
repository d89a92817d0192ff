#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "rhi/error.hpp"

namespace tandem::program {

/// What a job names by its position. Throws rhi::Error(invalid_argument) in the name of `label` where there is no such
/// thing.
/// @param what it is, in messages: "buffer"
template <typename T>
const T& at_position(const std::vector<T>& all, std::size_t position, std::string_view label, std::string_view what) {
  if (position >= all.size())
    throw rhi::Error(rhi::ErrorCode::invalid_argument, label,
                     "the job has no " + std::string(what) + " " + std::to_string(position));
  return all[position];
}

}  // namespace tandem::program
