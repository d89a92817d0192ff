#pragma once

#include <filesystem>
#include <string>

#include "program/job/job.hpp"
#include "rhi/glsl/compile.hpp"

namespace tandem::program {

/// A shader of a file: GLSL, whose extension names the stage (glsl::stage_of), SPIR-V (.spv), or the text of SPIR-V's
/// assembler (.spvasm), of the version that spirv-dis writes in front of it, else 1.5. The shader is named after the
/// file. Throws tandem::Error, naming the file, for one that cannot be read or has none of these extensions;
/// rhi::Error for what is no valid shader.
/// @param entry_point of a module that has several; "": the only one
Shader load_shader(const std::filesystem::path& path, const glsl::CompileOptions& options = {},
                   const std::string& entry_point = "");

}  // namespace tandem::program
