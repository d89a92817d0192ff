// tandem_spirv_fuzz: makes mutants of real modules and shader modules and kernels' sources of them, as the devices do.
// Each must end as a module or as an rhi::Error, soon and in bounded memory.

#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <fstream>
#include <map>
#include <random>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "rhi/error.hpp"
#include "rhi/glsl/compile.hpp"
#include "rhi/shader_reflection.hpp"
#include "rhi_cpu/translate/translate.hpp"
#include "shaders/spirv.hpp"
#include "tests/fuzz/module_mutation.hpp"

namespace {

using namespace tandem;
using Words = std::vector<std::uint32_t>;

/// Mutants of the path tracer itself would take most of the time and find the same.
std::vector<Words> modules() {
  const std::string common = R"(#version 460
#extension GL_EXT_ray_query : require
#extension GL_EXT_scalar_block_layout : require
layout(local_size_x_id = 1) in;
layout(constant_id = 0) const uint count = 3;
layout(constant_id = 2) const float scale = 2.0;
)";
  const auto compute = [&](const std::string& body) {
    return glsl::compile(common + body, rhi::ShaderStage::compute, "seed",
                         {.include_directories = {}, .debug_info = true});
  };
  std::vector<Words> result = {compute(R"(struct Item { vec3 p; mat3 m; float a[count]; };
layout(binding = 0, scalar) buffer Items { Item items[]; };
layout(binding = 1) uniform Sizes { uvec4 sizes[4]; };
layout(push_constant) uniform Constants { vec4 tint; uint first; };
float sum(Item item) { float s = 0; for (uint i = 0; i < count; ++i) s += item.a[i] * scale; return s; }
void main() {
  uint i = gl_GlobalInvocationID.x + first;
  if (i >= items.length()) return;
  switch (sizes[i & 3].x) { case 0: items[i].p = tint.xyz; break; case 7: items[i].m[1] *= 2.0; default: items[i].p.y = sum(items[i]); }
})"),
                               compute(R"(layout(binding = 0) uniform accelerationStructureEXT scene;
layout(binding = 1, std430) buffer Result { float t[]; };
layout(binding = 2, rgba32f) uniform image2D pictures[2];
void main() {
  rayQueryEXT query;
  rayQueryInitializeEXT(query, scene, 0u, 0xffu, vec3(0, 0, 5), 0.0, vec3(0, 0, -1), 100.0);
  while (rayQueryProceedEXT(query)) if (rayQueryGetIntersectionTypeEXT(query, false) == 0u) rayQueryConfirmIntersectionEXT(query);
  t[gl_GlobalInvocationID.x] = rayQueryGetIntersectionTEXT(query, true);
  imageStore(pictures[gl_GlobalInvocationID.x & 1], ivec2(0), imageLoad(pictures[0], ivec2(1)));

})"),
                               compute(R"(
#extension GL_EXT_nonuniform_qualifier : require
#extension GL_EXT_shader_explicit_arithmetic_types : require
layout(binding = 0) uniform sampler2D pictures[];
layout(binding = 3) uniform sampler2DArrayShadow depths;
layout(binding = 4, scalar) buffer Halves { f16vec3 halves[]; };
layout(binding = 6, scalar) buffer Bytes { i8vec4 bytes[count]; } aliases[];
layout(binding = 5) uniform samplerBuffer texels;
void main() {
  uint i = gl_GlobalInvocationID.x;
  vec4 sum = textureLod(pictures[nonuniformEXT(i)], vec2(0.5), scale) + texelFetch(texels, int(i));
  sum += textureGatherOffset(pictures[1], sum.xy, ivec2(1, -1), 2);
  sum.x += textureGrad(depths, sum, sum.xy, sum.zw);
  halves[i] = normalize(f16vec3(sum.xyz)) * float16_t(aliases[i].bytes[1].x);
  for (uint k = 0; k < count; ++k) halves[k] = fma(halves[i], halves[k], f16vec3(sum.w));
})")};
  for (const auto words : {shaders::path_trace_rmiss(), shaders::path_trace_rchit(), shaders::path_trace_rahit(),
                           shaders::path_trace_rint(), shaders::ray_answer_rgen(), shaders::path_log_rmiss()})
    result.emplace_back(words.begin(), words.end());
  return result;
}

/// What became of a mutant: the error's code and the kind of sentence, for the counts.
std::string outcome(const Words& words) {
  try {
    const rhi::ShaderReflection reflection = rhi::reflect(words, "mutant");
    cpu::translate(words, "mutant", {.robust = true, .watched = true});
    if (reflection.stage == rhi::ShaderStage::compute)
      cpu::translate(words, "mutant", {.robust = true, .watched = true, .lanes = 8});
    return "translated";
  } catch (const rhi::Error& error) {
    const std::string text = error.what();
    if (text.find("is not valid") != std::string::npos) return "refused by the validator";
    if (error.code() == rhi::ErrorCode::unsupported) return "unsupported";
    return "refused later";
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Makes shader modules of damaged SPIR-V");
  std::uint32_t seed = 1, count = 300, first = 0;
  double most_seconds = 10;
  std::string keep;
  app.add_option("--seed", seed, "of the mutations")->capture_default_str();
  app.add_option("--first", first, "number of the first mutant")->capture_default_str();
  app.add_option("--count", count, "mutants")->capture_default_str();
  app.add_option("--seconds", most_seconds, "that one mutant may take")->capture_default_str();
  app.add_option("--keep", keep, "write each mutant to this file first, so that it is there after a crash");
  CLI11_PARSE(app, argc, argv);
#ifndef __SANITIZE_ADDRESS__
  // Memory that a mutant asks for without bound shall fail here, not on the machine.
  const rlimit memory = {.rlim_cur = 3ull << 30, .rlim_max = 3ull << 30};
  setrlimit(RLIMIT_AS, &memory);
#endif
  const std::vector<Words> originals = modules();
  std::map<std::string, std::uint32_t> counts;
  bool failed = false;
  double slowest = 0;
  for (std::uint32_t number = first; number < first + count; ++number) {
    std::mt19937 random(seed * 1000003u + number);
    const Words words = test::mutated(originals[number % originals.size()], random);
    if (!keep.empty())
      std::ofstream(keep, std::ios::binary)
          .write(reinterpret_cast<const char*>(words.data()), static_cast<std::streamsize>(words.size() * 4));
    const auto start = std::chrono::steady_clock::now();
    std::string result;
    try {
      result = outcome(words);
    } catch (const std::exception& error) {
      result = std::string("another exception: ") + error.what();
      failed = true;
      fmt::print("mutant {}: {}\n", number, result);
    }
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    slowest = std::max(slowest, seconds);
    if (seconds > most_seconds) {
      failed = true;
      fmt::print("mutant {}: took {:.1f} s\n", number, seconds);
    }
    ++counts[result];
    std::fflush(stdout);
  }
  for (const auto& [result, times] : counts) fmt::print("{:6} {}\n", times, result);
  fmt::print("slowest: {:.2f} s\n", slowest);
  return failed ? 1 : 0;
}
