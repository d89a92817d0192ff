#pragma once

#include <string>

#include "compare/session/job.hpp"
#include "rhi/device.hpp"
#include "tools/options/render_options.hpp"

/// From the options of a command to a scene and devices.
namespace tandem::tools {

/// Loads the scene, prints its warnings, and completes the options: by what the scene's file says, then by defaults. A
/// camera that is given in part is completed from that of the file or the automatic one; one that is only given a
/// position looks at the scene's centre.
compare::Job load_job(const RenderOptions& options);

/// Creates the device; what it has to say from warnings on goes to standard error, from any thread.
rhi::DeviceHandle open_device(const std::string& name, const RenderOptions& options);

}  // namespace tandem::tools
