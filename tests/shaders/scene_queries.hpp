#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "tests/shaders/test_scene.hpp"
#include "tests/support/device_test.hpp"

namespace tandem::test {

/// Dispatches a shader of 64 invocations a workgroup, one for each query. Set 0 is the scene; queries are binding 2 of
/// set 1, answers binding 3.
void run_queries(rhi::Device& device, const DeviceScene& scene, const std::string& glsl, const std::string& label,
                 const rhi::BufferHandle& queries, const rhi::BufferHandle& answers, std::size_t count);

/// What the shader answers to the queries.
/// @param answers what the shader finds where it is to write
template <typename Query, typename Answer>
std::vector<Answer> answer_queries(rhi::Device& device, const DeviceScene& scene, const std::string& glsl,
                                   const std::string& label, const std::vector<Query>& queries,
                                   const std::vector<Answer>& answers) {
  const rhi::BufferHandle buffer = buffer_of(device, answers, "answers");
  run_queries(device, scene, glsl, label, buffer_of(device, queries, "queries"), buffer, queries.size());
  return contents<Answer>(device, buffer, answers.size());
}

}  // namespace tandem::test
