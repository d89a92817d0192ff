#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "tests/support/device_test.hpp"

namespace tandem::test {

/// Binds buffers to bindings 0, 1, ... of set 0, runs the pipeline in one submission and waits for it.
inline void run(rhi::Device& device, const rhi::ComputePipelineHandle& pipeline,
                const std::vector<rhi::BufferHandle>& buffers, std::uint32_t workgroups = 1,
                std::span<const std::byte> push_constants = {}) {
  rhi::BindGroupDesc bindings;
  bindings.pipeline = pipeline;
  bindings.label = "buffers of " + pipeline->label();
  for (std::uint32_t i = 0; i < buffers.size(); ++i)
    bindings.entries.push_back({.binding = i, .resource = rhi::BufferRange{buffers[i]}});
  const rhi::CommandListHandle list = device.create_command_list("run " + pipeline->label());
  list->dispatch({.pipeline = pipeline,
                  .bind_groups = {device.create_bind_group(bindings)},
                  .push_constants = push_constants,
                  .workgroup_count = {workgroups, 1, 1}});
  device.submit(list)->wait();
}

/// Whether calling `function` throws an rhi::Error with this code whose text contains `text`; what it throws instead,
/// or "nothing", is put into `seen`.
template <typename Function>
bool throws_error(rhi::ErrorCode code, const std::string& text, std::string& seen, Function&& function) {
  seen = "nothing";
  try {
    function();
  } catch (const rhi::Error& error) {
    seen = error.what();
    return error.code() == code && seen.find(text) != std::string::npos;
  }
  return false;
}

}  // namespace tandem::test

/// The expression throws rhi::Error(code) and says `text`.
#define CHECK_ERROR(code, text, ...)                                                                     \
  do {                                                                                                   \
    std::string seen_;                                                                                   \
    const bool as_expected_ =                                                                            \
        ::tandem::test::throws_error(::tandem::rhi::ErrorCode::code, text, seen_, [&] { __VA_ARGS__; }); \
    CHECK_MESSAGE(as_expected_, "expected " #code " with '" << text << "', got: " << seen_);             \
  } while (false)
