#pragma once

/// All that a translated shader is compiled with.
#include "rhi_cpu/kernel/abi.hpp"
#include "rhi_cpu/kernel/atomics.hpp"
#include "rhi_cpu/kernel/bits.hpp"
#include "rhi_cpu/kernel/components.hpp"
#include "rhi_cpu/kernel/geometry.hpp"
#include "rhi_cpu/kernel/images.hpp"
#include "rhi_cpu/kernel/integer_dot.hpp"
#include "rhi_cpu/kernel/math.hpp"
#include "rhi_cpu/kernel/matrices.hpp"
#include "rhi_cpu/kernel/memory.hpp"
#include "rhi_cpu/kernel/packing.hpp"
#include "rhi_cpu/kernel/ray_query.hpp"
#include "rhi_cpu/kernel/ray_tracing.hpp"
#include "rhi_cpu/kernel/shader_call.hpp"
#include "rhi_cpu/kernel/types.hpp"
