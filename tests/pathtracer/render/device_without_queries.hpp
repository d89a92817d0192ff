#pragma once

#include "rhi/device.hpp"

namespace tandem::test {

/// A device that passes everything on to another, but has no ray queries: it says so, and refuses compute pipelines,
/// which alone could use them.
rhi::DeviceHandle device_without_queries(rhi::Device& device);

}  // namespace tandem::test
