#pragma once

#include "rhi/device.hpp"
#include "tests/faults/device_edits.hpp"

namespace tandem::test {

/// A device that passes everything on to another, but for the edits. It calls itself `device`'s name with "faulty" in
/// front. Positions, boxes and instances that are edited must have come to their buffers by uploads, as float3 for
/// positions: rhi::Error(unsupported) else.
rhi::DeviceHandle faulty_device(rhi::DeviceHandle device, DeviceEdits edits);

}  // namespace tandem::test
