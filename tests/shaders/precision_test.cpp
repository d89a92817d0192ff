#include <doctest/doctest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <spirv/unified1/GLSL.std.450.h>
#include <spirv/unified1/spirv.hpp>

#include "rhi/glsl/compile.hpp"

using namespace tandem;

namespace {

const std::filesystem::path shader_directory = std::filesystem::path(TANDEM_SOURCE_DIRECTORY) / "shaders";

std::vector<std::uint32_t> compile(const std::string& source, rhi::ShaderStage stage = rhi::ShaderStage::compute) {
  return glsl::compile(source, stage, "precision test", {.include_directories = {shader_directory}});
}

/// What a module does that devices may round each in its own way.
struct Looseness {
  int arithmetic = 0;       ///< floating-point operations at all
  int contractible = 0;     ///< those without NoContraction
  std::set<int> opcodes;    ///< operations whose order or precision is the device's: OpDot, OpFMod, matrix products
  std::set<int> functions;  ///< instructions of GLSL.std.450 that are not exact
};

Looseness looseness_of(const std::vector<std::uint32_t>& spirv) {
  const std::set<int> arithmetic = {spv::OpFAdd, spv::OpFSub, spv::OpFMul, spv::OpFDiv, spv::OpVectorTimesScalar};
  const std::set<int> loose = {spv::OpDot,
                               spv::OpFMod,
                               spv::OpFRem,
                               spv::OpOuterProduct,
                               spv::OpMatrixTimesScalar,
                               spv::OpVectorTimesMatrix,
                               spv::OpMatrixTimesVector,
                               spv::OpMatrixTimesMatrix};
  const std::set<int> exact_functions = {GLSLstd450FAbs, GLSLstd450Floor, GLSLstd450Sqrt,
                                         GLSLstd450FMin, GLSLstd450FMax,  GLSLstd450NMin,
                                         GLSLstd450NMax, GLSLstd450UMin,  GLSLstd450UMax};
  Looseness result;
  std::set<std::uint32_t> results, precise;
  for (std::size_t word = 5; word < spirv.size(); word += spirv[word] >> 16) {
    const int opcode = static_cast<int>(spirv[word] & 0xffff);
    if (arithmetic.contains(opcode)) results.insert(spirv[word + 2]);
    if (loose.contains(opcode)) result.opcodes.insert(opcode);
    if (opcode == spv::OpDecorate && spirv[word + 2] == spv::DecorationNoContraction) precise.insert(spirv[word + 1]);
    if (opcode == spv::OpExtInst && !exact_functions.contains(static_cast<int>(spirv[word + 4])))
      result.functions.insert(static_cast<int>(spirv[word + 4]));
  }
  result.arithmetic = static_cast<int>(results.size());
  for (const std::uint32_t id : results) result.contractible += precise.contains(id) ? 0 : 1;
  return result;
}

}  // namespace

TEST_CASE("No device may contract, reorder or approximate anything in the path tracer") {
  const std::map<std::string, rhi::ShaderStage> stages = {
      {".comp", rhi::ShaderStage::compute},  {".rgen", rhi::ShaderStage::ray_generation},
      {".rmiss", rhi::ShaderStage::miss},    {".rchit", rhi::ShaderStage::closest_hit},
      {".rahit", rhi::ShaderStage::any_hit}, {".rint", rhi::ShaderStage::intersection}};
  std::map<std::string, int> arithmetic;
  for (const std::filesystem::directory_entry& entry : std::filesystem::directory_iterator(shader_directory)) {
    const auto stage = stages.find(entry.path().extension().string());
    if (stage == stages.end()) continue;
    const std::string name = entry.path().filename().string();
    CAPTURE(name);
    std::ifstream file(entry.path());
    const Looseness looseness = looseness_of(compile({std::istreambuf_iterator<char>(file), {}}, stage->second));
    arithmetic[name] = looseness.arithmetic;
    CHECK(looseness.contractible == 0);
    CHECK(looseness.opcodes.empty());
    CHECK(looseness.functions.empty());
  }
  for (const char* name : {"path_trace.comp", "path_trace.rgen"}) CHECK(arithmetic[name] > 100);
  for (const char* name : {"path_trace.rahit", "path_trace.rint"}) CHECK(arithmetic[name] > 20);
  CHECK(arithmetic.contains("path_trace.rchit"));
  CHECK(arithmetic.contains("path_trace.rmiss"));
}

TEST_CASE("No device may contract, reorder or approximate anything in the mathematical functions") {
  for (const char* define : {"", "#define TANDEM_EXACT_DIVISION\n"}) {
    const Looseness looseness = looseness_of(
        compile("#version 460\n#extension GL_GOOGLE_include_directive : require\n" + std::string(define) + R"(
layout(local_size_x = 1) in;
layout(set = 0, binding = 0, std430) buffer Values { float v[]; };
#include "math.glsl"
void main() {
  v[0] = det_sin(v[0]);
  v[1] = det_cos(v[1]);
  v[2] = det_exp(v[2]);
  v[3] = det_log(v[3]);
  v[4] = det_pow(v[4], v[5]);
  v[5] = det_acos(v[5]);
  v[6] = det_atan(v[6]);
  v[8] = det_atan2(v[6], v[7]);
  vec3 a = det_normalize(vec3(v[0], v[1], v[2]), vec3(1.0));
  v[7] = det_length(det_reflect(a, det_cross(a, vec3(v[3], v[4], v[5]))));
}
)"));
    CHECK(looseness.arithmetic > 100);
    CHECK(looseness.contractible == 0);
    CHECK(looseness.opcodes.empty());
    CHECK(looseness.functions.empty());
  }
}

TEST_CASE("Loose arithmetic is found") {
  const Looseness looseness = looseness_of(compile(R"(#version 460
layout(local_size_x = 1) in;
layout(set = 0, binding = 0, std430) buffer Values { float v[]; };
void main() { v[0] = dot(vec2(v[0], v[1]), vec2(v[2], v[3])) + sin(v[4]) * v[5]; }
)"));
  CHECK(looseness.arithmetic == 2);
  CHECK(looseness.contractible == 2);
  CHECK(looseness.opcodes == std::set<int>{spv::OpDot});
  CHECK(looseness.functions == std::set<int>{GLSLstd450Sin});
}
