#include "tests/faults/fault.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cstdint>
#include <set>
#include <span>
#include <string>
#include <vector>

#include <spirv-tools/libspirv.hpp>

#include "shaders/spirv.hpp"

using namespace tandem;
using namespace tandem::test;

namespace {

struct Shader {
  std::span<const std::uint32_t> spirv;
  rhi::ShaderStage stage;
};

/// What renders a picture: whatever can be wrong with a path can be wrong here.
std::vector<Shader> picture_shaders(pathtracer::TracingMode form) {
  using rhi::ShaderStage;
  if (form == pathtracer::TracingMode::query) return {{shaders::path_trace(), ShaderStage::compute}};
  return {{shaders::path_trace_rgen(), ShaderStage::ray_generation},
          {shaders::path_trace_rmiss(), ShaderStage::miss},
          {shaders::path_trace_rchit(), ShaderStage::closest_hit},
          {shaders::path_trace_rahit(), ShaderStage::any_hit},
          {shaders::path_trace_rint(), ShaderStage::intersection}};
}

}  // namespace

TEST_CASE("Faults have names of their own, and say what they do") {
  std::set<std::string> names;
  for (const Fault& fault : all_faults()) {
    CHECK_MESSAGE(names.insert(fault.name).second, fault.name);
    CHECK_FALSE(fault.meaning.empty());
    CHECK_FALSE(fault.scene.empty());
  }
  CHECK(names.size() >= 40);
}

TEST_CASE("Shaders with a fault are valid SPIR-V, and other shaders than before") {
  for (const Fault& fault : all_faults()) {
    if (!fault.edits.shader || fault.finder == Finder::probes || fault.finder == Finder::survey) continue;
    CAPTURE(fault.name);
    int edited = 0;
    for (const Shader& shader : picture_shaders(fault.form)) {
      SpirvModule module(shader.spirv);
      if (!fault.edits.shader(module, shader.stage)) continue;
      ++edited;
      spvtools::SpirvTools tools(SPV_ENV_VULKAN_1_2);
      std::string said;
      tools.SetMessageConsumer(
          [&](spv_message_level_t, const char*, const spv_position_t&, const char* message) { said += message; });
      CHECK(tools.Validate(module.words()));
      CHECK(said == "");
      CHECK((module.words() != SpirvModule(shader.spirv).words()) == (fault.name != "none-compiled-anew"));
    }
    CHECK(edited > 0);
  }
}
