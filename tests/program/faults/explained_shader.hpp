#pragma once

#include <string>
#include <vector>

#include "program/explain/explanation.hpp"
#include "program/job/job.hpp"

/// Shaders of several kinds, each with a job that runs all of it, into which faults are put.
namespace tandem::test {

struct ExplainedShader {
  std::string name;
  program::Job job;
};

/// Floats and functions of GLSL; integers; shared memory and atomics; control flow, vectors and matrices; ray queries.
std::vector<ExplainedShader> explained_shaders();

}  // namespace tandem::test
