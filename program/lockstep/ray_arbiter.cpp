#include "program/lockstep/ray_arbiter.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include "program/lockstep/divergence.hpp"
#include "rhi/glsl/compile.hpp"

namespace tandem::program {
namespace {

constexpr std::uint32_t ray_count = 65;  ///< the ray, and 64 neighbours
constexpr float reach = 0x1p-21f;        ///< of the neighbours, relative to the scene: 4 units in the last place

/// Of one ray: what it commits to, and the candidates that the shader is shown before, if it lets none through.
constexpr std::uint32_t answers_per_ray = 16;

/// Which of the triangles that are not opaque a shader lets through, the arbiter does not know. flags_mask.z: whether
/// all of them, as for a shader that is shown none.
constexpr const char* tracing = R"(#version 460
#extension GL_EXT_ray_query : require
layout(local_size_x = 1) in;
layout(set = 0, binding = 0) uniform accelerationStructureEXT scene;
struct Ray { vec4 origin_minimum; vec4 direction_maximum; uvec4 flags_mask; };
layout(set = 0, binding = 1, std430) readonly buffer Rays { Ray rays[]; };
struct Answer {
  uint type; float t; vec2 barycentrics; uint instance, custom_index, geometry, primitive, front_face, unused[3];
};
layout(set = 0, binding = 2, std430) writeonly buffer Answers { Answer answers[]; };
#define ANSWER(query, committed) Answer(1u, rayQueryGetIntersectionTEXT(query, committed), \
    rayQueryGetIntersectionBarycentricsEXT(query, committed), rayQueryGetIntersectionInstanceIdEXT(query, committed), \
    rayQueryGetIntersectionInstanceCustomIndexEXT(query, committed), \
    rayQueryGetIntersectionGeometryIndexEXT(query, committed), \
    rayQueryGetIntersectionPrimitiveIndexEXT(query, committed), \
    rayQueryGetIntersectionFrontFaceEXT(query, committed) ? 1u : 0u, uint[](0u, 0u, 0u))
void main() {
  uint i = gl_GlobalInvocationID.x;
  Ray ray = rays[i];
  bool lets_through = ray.flags_mask.z != 0u;
  const uint per_ray = 16u;
  for (uint k = 0u; k < per_ray; ++k) answers[per_ray * i + k].type = 0u;
  rayQueryEXT query;
  rayQueryInitializeEXT(query, scene, ray.flags_mask.x, ray.flags_mask.y, ray.origin_minimum.xyz, ray.origin_minimum.w,
                        ray.direction_maximum.xyz, ray.direction_maximum.w);
  uint count = 1u;
  while (rayQueryProceedEXT(query))
    if (rayQueryGetIntersectionTypeEXT(query, false) == gl_RayQueryCandidateIntersectionTriangleEXT) {
      if (lets_through) rayQueryConfirmIntersectionEXT(query);
      else if (count < per_ray) answers[per_ray * i + count++] = ANSWER(query, false);
    }
  if (rayQueryGetIntersectionTypeEXT(query, true) == gl_RayQueryCommittedIntersectionTriangleEXT)
    answers[per_ray * i] = ANSWER(query, true);
}
)";

/// What an instruction asks of a hit.
enum class Question { type, t, barycentrics, instance, custom_index, geometry, primitive, front_face };

std::optional<Question> question_of(spv::Op op) {
  switch (op) {
    case spv::OpRayQueryGetIntersectionTypeKHR:
      return Question::type;
    case spv::OpRayQueryGetIntersectionTKHR:
      return Question::t;
    case spv::OpRayQueryGetIntersectionBarycentricsKHR:
      return Question::barycentrics;
    case spv::OpRayQueryGetIntersectionInstanceIdKHR:
      return Question::instance;
    case spv::OpRayQueryGetIntersectionInstanceCustomIndexKHR:
      return Question::custom_index;
    case spv::OpRayQueryGetIntersectionGeometryIndexKHR:
      return Question::geometry;
    case spv::OpRayQueryGetIntersectionPrimitiveIndexKHR:
      return Question::primitive;
    case spv::OpRayQueryGetIntersectionFrontFaceKHR:
      return Question::front_face;
    default:
      return std::nullopt;
  }
}

std::optional<Question> question_of_input(const Module& module, std::uint32_t variable) {
  const Instruction& declared = definition(module, variable);
  if (declared.op != spv::OpVariable) return std::nullopt;
  if (declared.words[3] == spv::StorageClassHitAttributeKHR) return Question::barycentrics;
  switch (built_in_of(module, variable)) {
    case spv::BuiltInRayTmaxKHR:
      return Question::t;
    case spv::BuiltInInstanceId:
      return Question::instance;
    case spv::BuiltInInstanceCustomIndexKHR:
      return Question::custom_index;
    case spv::BuiltInRayGeometryIndexKHR:
      return Question::geometry;
    case spv::BuiltInPrimitiveId:
      return Question::primitive;
    default:
      return std::nullopt;
  }
}

/// Whether a ray may show a shader what it meets before it is committed.
bool has_candidates(const Job& job) {
  for (const BottomLevel& level : job.bottom_levels)
    for (const auto& geometry : level.geometries) {
      const auto* triangles = std::get_if<Triangles>(&geometry);
      if (triangles == nullptr || !rhi::has(triangles->flags, rhi::GeometryFlags::opaque)) return true;
    }
  return std::ranges::any_of(job.top_levels, [](const TopLevel& top) {
    return std::ranges::any_of(top.instances, [](const Instance& instance) {
      return rhi::has(instance.flags, rhi::InstanceFlags::force_no_opaque);
    });
  });
}

bool has_boxes(const Job& job) {
  return std::ranges::any_of(job.bottom_levels, [](const BottomLevel& level) {
    return std::ranges::any_of(level.geometries,
                               [](const auto& geometry) { return !std::holds_alternative<Triangles>(geometry); });
  });
}

/// In [-1, 1], the same for the same numbers.
float spread(std::uint32_t ray, std::uint32_t axis) {
  std::uint32_t x = ray * 0x9e3779b9u + axis * 0x85ebca6bu;
  x = (x ^ x >> 16) * 0x7feb352du;
  x = (x ^ x >> 15) * 0x846ca68bu;
  x ^= x >> 16;
  return static_cast<float>(x >> 8) * 0x1p-23f - 1;
}

}  // namespace

struct RayArbiter::Ray {
  std::size_t top_level = 0;
  std::array<float, 4> origin_minimum, direction_maximum;
  std::array<std::uint32_t, 4> flags_mask;
};

struct RayArbiter::Answer {
  std::array<std::uint32_t, 12> words;

  /// What the question asks, as the words of the instruction's result.
  std::vector<std::uint32_t> of(Question question) const {
    switch (question) {
      case Question::type:
        return {words[0]};
      case Question::t:
        return {words[1]};
      case Question::barycentrics:
        return {words[2], words[3]};
      case Question::instance:
        return {words[4]};
      case Question::custom_index:
        return {words[5]};
      case Question::geometry:
        return {words[6]};
      case Question::primitive:
        return {words[7]};
      case Question::front_face:
        return {words[8]};
    }
    return {};
  }
};

struct RayArbiter::Tracer {
  Job job;
  std::unique_ptr<Execution> execution;
};

RayArbiter::RayArbiter(rhi::Device& exact, const Job& job)
    : exact_(exact), job_(job), extent_(extent()), has_candidates_(has_candidates(job)), has_boxes_(has_boxes(job)) {}

RayArbiter::~RayArbiter() = default;

float RayArbiter::extent() const {
  float largest = 0;
  for (const TopLevel& top : job_.top_levels)
    for (const Instance& instance : top.instances) {
      const std::array<float, 12>& m = instance.object_to_world;
      for (const auto& geometry : job_.bottom_levels.at(instance.bottom_level).geometries)
        if (const auto* triangles = std::get_if<Triangles>(&geometry))
          for (const auto& p : triangles->positions)
            for (std::size_t row = 0; row < 3; ++row)
              largest = std::max(largest, std::fabs(m[4 * row] * p[0]) + std::fabs(m[4 * row + 1] * p[1]) +
                                              std::fabs(m[4 * row + 2] * p[2]) + std::fabs(m[4 * row + 3]));
    }
  return largest;
}

std::optional<std::size_t> RayArbiter::top_level_of(const Module& module, std::uint32_t structure) const {
  const auto found = module.definitions.find(structure);
  std::optional<std::uint32_t> set, binding;
  if (found != module.definitions.end() && module.instructions[found->second].op == spv::OpLoad) {
    const std::uint32_t variable = module.instructions[found->second].words[3];
    for (std::size_t i = 0; i < module.first_global; ++i) {
      const Instruction& instruction = module.instructions[i];
      if (instruction.op != spv::OpDecorate || instruction.words[1] != variable) continue;
      if (instruction.words[2] == spv::DecorationDescriptorSet) set = instruction.words[3];
      if (instruction.words[2] == spv::DecorationBinding) binding = instruction.words[3];
    }
  }
  for (const Binding& each : job_.pipelines.at(0).bindings)
    if (const auto* use = std::get_if<TopLevelUse>(&each.resource); use && set == each.set && binding == each.binding)
      return use->top_level;
  return job_.top_levels.size() == 1 ? std::optional<std::size_t>(0) : std::nullopt;
}

std::optional<RayArbiter::Ray> RayArbiter::ray_of(const RecordedShader& shader, const OperandValues& operands) const {
  const Instruction& instruction = shader.module.instructions[operands.instruction];
  const bool is_query = instruction.op == spv::OpRayQueryInitializeKHR;
  // Of both instructions the structure, flags and mask come first (behind the query); of a trace three more numbers.
  const std::size_t first = is_query ? 1 : 0, ray = is_query ? 4 : 6;
  if (operands.values.size() < ray + 4) return std::nullopt;
  const auto words = [&](std::size_t operand) -> const std::vector<std::uint32_t>* {
    return operands.values[operand] ? &operands.values[operand]->words : nullptr;
  };
  for (const std::size_t each : {first + 1, first + 2, ray, ray + 1, ray + 2, ray + 3})
    if (words(each) == nullptr) return std::nullopt;
  const std::optional<std::size_t> top_level =
      top_level_of(shader.module, instruction.words[instruction.used_ids[first]]);
  if (!top_level) return std::nullopt;
  const auto number = [&](std::size_t operand, std::size_t word) {
    return std::bit_cast<float>((*words(operand))[word]);
  };
  return Ray{.top_level = *top_level,
             .origin_minimum = {number(ray, 0), number(ray, 1), number(ray, 2), number(ray + 1, 0)},
             .direction_maximum = {number(ray + 2, 0), number(ray + 2, 1), number(ray + 2, 2), number(ray + 3, 0)},
             .flags_mask = {(*words(first + 1))[0], (*words(first + 2))[0], 0, 0}};
}

bool RayArbiter::shows_candidates(const Ray& ray) const {
  const std::uint32_t flags = ray.flags_mask[0];
  if ((flags & spv::RayFlagsOpaqueKHRMask) != 0) return false;
  return has_candidates_ || (flags & spv::RayFlagsNoOpaqueKHRMask) != 0;
}

std::vector<RayArbiter::Answer> RayArbiter::answers(const Ray& ray) const {
  std::unique_ptr<Tracer>& tracer = tracers_[ray.top_level];
  if (tracer == nullptr) {
    tracer = std::make_unique<Tracer>();
    tracer->job = {
        .shaders = {{.name = "arbiter", .spirv = glsl::compile(tracing, rhi::ShaderStage::compute, "arbiter")}},
        .buffers = {{.name = "rays", .initial = std::vector<std::byte>(ray_count * 48)},
                    {.name = "answers",
                     .initial = std::vector<std::byte>(ray_count * answers_per_ray * sizeof(Answer))}},
        .bottom_levels = job_.bottom_levels,
        .top_levels = {job_.top_levels[ray.top_level]},
        .pipelines = {{.name = "arbiter",
                       .stages = ComputeStages{},
                       .bindings = {{.set = 0, .binding = 0, .resource = TopLevelUse{}},
                                    {.set = 0, .binding = 1, .resource = BufferUse{.buffer = 0}},
                                    {.set = 0, .binding = 2, .resource = BufferUse{.buffer = 1}}}}},
        .commands = {Dispatch{.workgroup_count = {ray_count, 1, 1}}}};
    tracer->execution = std::make_unique<Execution>(exact_, tracer->job);
  }
  float origin_scale = extent_, direction_scale = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    origin_scale = std::max(origin_scale, std::fabs(ray.origin_minimum[axis]));
    direction_scale = std::max(direction_scale, std::fabs(ray.direction_maximum[axis]));
  }
  std::vector<std::byte> bytes;
  for (std::uint32_t i = 0; i < ray_count; ++i) {
    Ray neighbour = ray;
    neighbour.flags_mask[2] = shows_candidates(ray) ? 0 : 1;
    for (std::uint32_t axis = 0; axis < 3 && i != 0; ++axis) {
      neighbour.origin_minimum[axis] += spread(i, axis) * reach * origin_scale;
      neighbour.direction_maximum[axis] += spread(i, axis + 3) * reach * direction_scale;
    }
    for (const auto& part :
         {std::as_bytes(std::span(neighbour.origin_minimum)), std::as_bytes(std::span(neighbour.direction_maximum)),
          std::as_bytes(std::span(neighbour.flags_mask))})
      bytes.insert(bytes.end(), part.begin(), part.end());
  }
  tracer->execution->set_buffer(0, bytes);
  tracer->execution->run();
  const std::vector<std::byte> result = tracer->execution->buffer(1);
  std::vector<Answer> answers(ray_count * answers_per_ray);
  std::memcpy(answers.data(), result.data(), result.size());
  // Of a ray that meets nothing, that is an answer; behind the last candidate there is none.
  std::vector<Answer> given;
  for (std::size_t i = 0; i < answers.size(); ++i)
    if (i % answers_per_ray == 0 || answers[i].words[0] != 0) given.push_back(answers[i]);
  return given;
}

std::optional<Judgement> RayArbiter::judge(const Walk& walk, const Divergence& difference) const {
  const Module& module = walk.shader().module;
  const Instruction& instruction = module.instructions[difference.instruction];
  std::optional<Question> question = question_of(instruction.op);
  const OperandValues* operands = nullptr;
  const RecordedShader* asker = &walk.shader();
  if (question) {
    const std::optional<RecordedWords> committed = walk.value_of(instruction.words[4]);
    if (!committed || committed->words[0] == 0)
      return Judgement{.cause = Cause::order, .wrong = WrongDevice::none, .reason = "candidates come in any order"};
    operands = walk.query_ray(instruction.words[3]);
  } else if (instruction.op == spv::OpRayQueryProceedKHR) {
    return Judgement{.cause = Cause::order, .wrong = WrongDevice::none, .reason = "candidates come in any order"};
  } else if (instruction.op == spv::OpLoad) {
    question = question_of_input(module, walk.variable_of(instruction.words[3]));
    if (question && walk.shader().stage != rhi::ShaderStage::closest_hit)
      return Judgement{.cause = Cause::order, .wrong = WrongDevice::none, .reason = "candidates come in any order"};
    operands = walk.traced_ray(asker);
  }
  if (!question || operands == nullptr) return std::nullopt;
  const std::optional<Ray> ray = ray_of(*asker, *operands);
  if (!ray) return std::nullopt;

  const bool has_candidates = shows_candidates(*ray);
  const Judgement any_candidate{.cause = Cause::order,
                                .wrong = WrongDevice::none,
                                .reason = "which candidates the shader lets through depends on their order"};
  // Whether a ray meets anything is then the shader's decision, as is where it meets a box.
  if (has_candidates && (*question == Question::type || has_boxes_)) return any_candidate;

  // A load of one component compares just that.
  std::size_t component = 0;
  const bool is_float = *question == Question::t || *question == Question::barycentrics;
  if (*question == Question::barycentrics && difference.a.words.size() == 1)
    if (const Instruction& pointer = definition(module, instruction.words[3]); pointer.op == spv::OpAccessChain)
      if (const std::optional<RecordedWords> index = walk.value_of(pointer.words[4])) component = index->words[0] & 1;
  const std::vector<Answer> all = answers(*ray);
  const auto is_near_one = [&](float seen, std::size_t i) {
    return std::ranges::any_of(all, [&](const Answer& each) {
      const float answer = std::bit_cast<float>(each.of(*question)[component + i]);
      return each.words[0] != 0 && std::fabs(seen - answer) <= 256 * reach * std::max(1.0f, std::fabs(answer));
    });
  };
  const auto holds = [&](const RecordedWords& value) {
    for (std::size_t i = 0; i < value.words.size(); ++i) {
      const float seen = std::bit_cast<float>(value.words[i]);
      if (!is_float) {
        if (std::ranges::none_of(all, [&](const Answer& each) { return each.of(*question)[i] == value.words[i]; }))
          return false;
        continue;
      }
      if (has_candidates) {
        if (!is_near_one(seen, i)) return false;
        continue;
      }
      float least = INFINITY, most = -INFINITY;
      for (const Answer& each : all) {
        if (each.words[0] == 0) continue;
        const float answer = std::bit_cast<float>(each.of(*question)[component + i]);
        least = std::min(least, answer);
        most = std::max(most, answer);
      }
      const float slack = (most - least) + 16 * reach * std::max({1.0f, std::fabs(least), std::fabs(most)});
      if (!(seen >= least - slack && seen <= most + slack)) return false;
    }
    return true;
  };
  const bool a = holds(difference.a), b = holds(difference.b);
  if (a && b && has_candidates) return any_candidate;
  if (a && b)
    return Judgement{.cause = is_float ? Cause::within_precision : Cause::tie,
                     .wrong = WrongDevice::none,
                     .reason = "rays that differ from this one by a few ulp give both answers"};
  return Judgement{.cause = Cause::mismatch,
                   .wrong = a   ? WrongDevice::b
                            : b ? WrongDevice::a
                                : WrongDevice::both,
                   .reason = "no ray within a few ulp of this one gives that answer"};
}

}  // namespace tandem::program
