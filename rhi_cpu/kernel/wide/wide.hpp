#pragma once

/// What a kernel of the wide form includes; together.hpp too if it has subgroup operations.
#include "rhi_cpu/kernel/kernel.hpp"
#include "rhi_cpu/kernel/wide/functions.hpp"
#include "rhi_cpu/kernel/wide/images.hpp"
#include "rhi_cpu/kernel/wide/lanes.hpp"
#include "rhi_cpu/kernel/wide/memory.hpp"
#include "rhi_cpu/kernel/wide/ray_query.hpp"
