#pragma once

#include <cstddef>
#include <functional>

#include "tests/family/shader_tree.hpp"

namespace tandem::family {

/// The shader with as much as possible left out while `fails` stays true: functions, statements, the statements around
/// others, operations around their operands. Asks at most `limit` times.
ShaderTree reduced(ShaderTree shader, const std::function<bool(const ShaderTree&)>& fails, std::size_t limit);

}  // namespace tandem::family
