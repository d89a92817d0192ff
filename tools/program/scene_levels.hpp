#pragma once

#include <cstddef>

#include "program/job/job.hpp"
#include "tools/program/run_options.hpp"

namespace tandem::tools::program_run {

/// Adds the geometry of a scene's file to the job: a top level with an instance of all triangles, whose hit record is
/// number 0, and one of all spheres, as boxes, whose hit record is `box_record`. The primitives are in the order of the
/// scene. Returns the position of the top level. Throws Error.
std::size_t add_scene(program::Job& job, const Setting& setting, bool is_opaque, std::uint32_t box_record);

}  // namespace tandem::tools::program_run
