#include "conformance/workgroup/subgroup_run.hpp"

#include <bit>
#include <map>
#include <utility>

namespace tandem::conformance {
namespace {

/// Words before the columns: gl_SubgroupID, gl_SubgroupInvocationID, gl_SubgroupSize, gl_NumSubgroups.
constexpr std::uint32_t place_words = 4;

const std::string kernel_text = R"(
layout(local_size_x = SIZE_X, local_size_y = SIZE_Y, local_size_z = SIZE_Z) in;
layout(binding = 0, std430) buffer Answers { uint answers[]; };
DECLARATIONS
void main() ATTRIBUTES {
  const uint group = (gl_WorkGroupID.z * gl_NumWorkGroups.y + gl_WorkGroupID.y) * gl_NumWorkGroups.x + gl_WorkGroupID.x;
  const uint i = group * (SIZE_X * SIZE_Y * SIZE_Z) + gl_LocalInvocationIndex;
  uint at = i * STRIDE;
  answers[at] = gl_SubgroupID;
  answers[at + 1] = gl_SubgroupInvocationID;
  answers[at + 2] = gl_SubgroupSize;
  answers[at + 3] = gl_NumSubgroups;
  at += 4;
BODY
}
)";

std::string glsl_of(const SubgroupKernel& kernel) {
  std::string glsl = "#extension GL_KHR_shader_subgroup_basic : require\n";
  for (const std::string& extension : kernel.extensions) glsl += "#extension " + extension + " : require\n";
  std::string text = with(kernel_text, "STRIDE", std::to_string(place_words + kernel.columns));
  text = with(text, "SIZE_X", std::to_string(kernel.local_size[0]));
  text = with(text, "SIZE_Y", std::to_string(kernel.local_size[1]));
  text = with(text, "SIZE_Z", std::to_string(kernel.local_size[2]));
  text = with(text, "ATTRIBUTES", kernel.main_attributes);
  text = with(text, "DECLARATIONS", kernel.declarations);
  return glsl + with(text, "BODY", kernel.body);
}

/// The subgroup of the invocation, made at its first one.
Subgroup& subgroup_of(std::map<std::pair<std::uint32_t, std::uint32_t>, Subgroup>& subgroups, std::uint32_t workgroup,
                      std::span<const std::uint32_t> place) {
  const auto [entry, made] = subgroups.try_emplace({workgroup, place[0]});
  Subgroup& subgroup = entry->second;
  if (made) subgroup = {.size = place[2], .workgroup = workgroup, .id = place[0], .count = place[3], .lanes = {}};
  const std::string whose = fmt::format("subgroup {} of workgroup {}", place[0], workgroup);
  check(std::has_single_bit(place[2]) && place[2] <= 128,
        fmt::format("gl_SubgroupSize of {} is {}, expected a power of two up to 128", whose, place[2]));
  check_equal("gl_SubgroupSize within " + whose, place[2], subgroup.size);
  check_equal("gl_NumSubgroups within " + whose, place[3], subgroup.count);
  check(place[0] < place[3], fmt::format("gl_SubgroupID is {} of {} subgroups", place[0], place[3]));
  check(place[1] < place[2], fmt::format("gl_SubgroupInvocationID is {} of {} lanes", place[1], place[2]));
  subgroup.lanes.resize(subgroup.size);
  check(subgroup.lanes[place[1]] == nullptr, fmt::format("two invocations have lane {} of {}", place[1], whose));
  return subgroup;
}

}  // namespace

SubgroupAnswers run_subgroups(Context& context, const SubgroupKernel& kernel) {
  require_local_size(context, kernel.local_size);
  const std::uint32_t workgroup_size = kernel.local_size[0] * kernel.local_size[1] * kernel.local_size[2];
  const std::uint32_t workgroups = kernel.workgroup_count[0] * kernel.workgroup_count[1] * kernel.workgroup_count[2];
  const std::uint32_t stride = place_words + kernel.columns;
  const std::uint32_t count = workgroups * workgroup_size;
  SubgroupAnswers seen;
  seen.words = answers(context,
                       {.label = kernel.label,
                        .glsl = glsl_of(kernel),
                        .workgroup_count = kernel.workgroup_count,
                        .options = kernel.options},
                       std::size_t{count} * stride);
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::span<const std::uint32_t> words = std::span(seen.words).subspan(std::size_t{i} * stride, stride);
    seen.invocations.push_back(
        {.index = i, .subgroup = words[0], .lane = words[1], .answers = words.subspan(place_words)});
  }
  std::map<std::pair<std::uint32_t, std::uint32_t>, Subgroup> subgroups;
  for (const Invocation& invocation : seen.invocations) {
    const std::span<const std::uint32_t> place =
        std::span(seen.words).subspan(std::size_t{invocation.index} * stride, place_words);
    Subgroup& subgroup = subgroup_of(subgroups, invocation.index / workgroup_size, place);
    check_equal("gl_NumSubgroups of another invocation of the workgroup", place[3],
                subgroups.lower_bound({subgroup.workgroup, 0})->second.count);
    subgroup.lanes[invocation.lane] = &invocation;
  }
  for (auto& [where, subgroup] : subgroups) seen.subgroups.push_back(std::move(subgroup));
  return seen;
}

std::uint32_t words_of(const std::string& type) {
  return type == "double" || type == "int64_t" || type == "uint64_t" ? 2 : 1;
}

std::string put_function(const std::string& type) {
  const auto function = [&](const std::string& body) { return "void put(uint at, " + type + " x) { " + body + " }\n"; };
  if (type == "double") return function("uvec2 w = unpackDouble2x32(x); answers[at] = w.x; answers[at + 1] = w.y;");
  if (words_of(type) == 2) return function("answers[at] = uint(x); answers[at + 1] = uint(x >> 32);");
  if (type == "float" || type == "float16_t") return function("answers[at] = floatBitsToUint(float(x));");
  return function("answers[at] = uint(x);");
}

std::vector<std::uint32_t> lanes_of(const Subgroup& subgroup) {
  std::vector<std::uint32_t> lanes;
  for (std::uint32_t lane = 0; lane < subgroup.lanes.size(); ++lane)
    if (subgroup.lanes[lane] != nullptr) lanes.push_back(lane);
  return lanes;
}

void require_local_size(Context& context, const std::array<std::uint32_t, 3>& size) {
  const rhi::Limits& limits = context.device().info().limits;
  for (std::size_t k = 0; k < 3; ++k)
    if (size[k] > limits.max_workgroup_size[k])
      throw Unsupported(fmt::format("the device allows workgroups of {} in dimension {}, not {}",
                                    limits.max_workgroup_size[k], k, size[k]));
  if (size[0] * size[1] * size[2] > limits.max_workgroup_invocations)
    throw Unsupported(fmt::format("the device allows {} invocations in a workgroup, not {}",
                                  limits.max_workgroup_invocations, size[0] * size[1] * size[2]));
}

}  // namespace tandem::conformance
