#include <fmt/format.h>

#include "rhi/spirv/names.hpp"
#include "rhi_cpu/kernel/shader_call.hpp"
#include "rhi_cpu/translate/printer.hpp"
#include "rhi_cpu/translate/value_layout.hpp"

namespace tandem::cpu {

using spirv_cross::SPIRBlock;
using spirv_cross::SPIRConstant;
using spirv_cross::SPIRExpression;
using spirv_cross::SPIRFunction;
using spirv_cross::SPIRType;
using spirv_cross::SPIRVariable;

bool Printer::is_traced() const { return reflection_.stage != rhi::ShaderStage::compute; }

void Printer::set_up_endings() {
  // OpIgnoreIntersectionKHR and OpTerminateRayKHR end blocks. They become instructions in front of a Kill, which
  // SPIRV-Cross takes for a block that nothing follows.
  ir.for_each_typed_id<SPIRBlock>([](std::uint32_t, SPIRBlock& block) {
    const bool ignores = block.terminator == SPIRBlock::IgnoreIntersection;
    if (!ignores && block.terminator != SPIRBlock::TerminateRay) return;
    spirv_cross::Instruction ending;
    ending.op = ignores ? spv::OpIgnoreIntersectionKHR : spv::OpTerminateRayKHR;
    block.ops.push_back(ending);
    block.terminator = SPIRBlock::Kill;
  });
  backend.discard_literal = "__builtin_unreachable()";

  const auto can_end = [&](const auto& self, std::uint32_t id) -> bool {
    bool found = false;
    for (const auto& block_id : get<SPIRFunction>(id).blocks) {
      auto& block = get<SPIRBlock>(block_id);
      bool in_block = false;
      for (const auto& instruction : block.ops) {
        switch (instruction.op) {
          case spv::OpIgnoreIntersectionKHR:
          case spv::OpTerminateRayKHR:
          case spv::OpReportIntersectionKHR:
            in_block = true;
            break;
          case spv::OpFunctionCall:
            in_block |= self(self, view(instruction).operand(0));
            break;
          default:
            break;
        }
      }
      // SPIRV-Cross would print it as the third expression of a for statement, where no return can be.
      if (in_block) block.complex_continue = true;
      found |= in_block;
    }
    if (found) ending_functions_.insert(id);
    return found;
  };
  can_end(can_end, ir.default_entry_point);
}

std::string Printer::ending() {
  if (std::uint32_t(current_function->self) == std::uint32_t(ir.default_entry_point)) return "return;";
  const bool has_value = get<Type>(current_function->return_type).basetype != SPIRType::Void;
  return has_value ? "{ ended = true; return {}; }" : "{ ended = true; return; }";
}

void Printer::print_call_ending(std::uint32_t function_id) {
  if (ending_functions_.contains(function_id)) statement("if (ended) ", ending());
}

void Printer::print_traced_members() {
  statement("k::ShaderCall& shader_call;");
  ir.for_each_typed_id<SPIRVariable>([&](std::uint32_t id, SPIRVariable& variable) {
    if (!is_payload(variable.storage)) return;
    const std::string type = type_name(pointee(variable.basetype));
    statement(type, "& ", to_name(id), ";");
    payloads_.emplace_back(type, to_name(id));
  });
  statement("const k::Resource* resources = shader_call.resources;");
  statement("const std::byte* push_constants = shader_call.push_constants;");
  statement("const std::byte* shader_record = shader_call.shader_record;");
  statement("bool ended = false;");
  ir.for_each_typed_id<SPIRVariable>([&](std::uint32_t id, SPIRVariable& variable) {
    const bool incoming = is_incoming_payload(variable.storage);
    if (!incoming && variable.storage != spv::StorageClassHitAttributeKHR) return;
    const std::uint32_t type_id = pointee(variable.basetype);
    const std::string type = type_name(type_id);
    if (incoming) {
      incoming_payload_type_ = type;
    } else if (const std::uint32_t size = value_layout(*this, get<Type>(type_id)).size;
               size > kernel::max_hit_attribute_size) {
      fail(fmt::format("a hit attribute of {} bytes, which is more than {},", size, kernel::max_hit_attribute_size));
    }
    statement(type, "& ", to_name(id), " = *static_cast<", type, "*>(shader_call.",
              incoming ? "payload" : "hit_attributes", ");");
  });
}

void Printer::print_shader_call() {
  // Payloads are variables of their own, so that the rest of the invocation can stay in registers while a ray is
  // traced.
  std::string declarations, arguments = "shader_call";
  for (const auto& [type, name] : payloads_) {
    declarations += fmt::format("  {} {}{{}};\n", type, name);
    arguments += ", " + name;
  }
  statement("void call(k::ShaderCall& shader_call) {\n", declarations, "  Invocation{", arguments,
            "}.entry_point();\n}\n");
}

void Printer::print_trace_ray(const Instruction& i) {
  std::string arguments = value(i.operand(0));
  for (std::size_t k = 1; k <= 5; ++k) arguments += ", " + value_with_sign(i.operand(k), Sign::as_unsigned);
  for (std::size_t k = 6; k <= 10; ++k) arguments += ", " + value(i.operand(k));
  statement("k::traceRayEXT(shader_call, ", arguments, ");");
}

void Printer::print_execute_callable(const Instruction& i) {
  statement(fmt::format("k::executeCallableEXT(shader_call, {}, {});", value_with_sign(i.operand(0), Sign::as_unsigned),
                        value(i.operand(1))));
}

void Printer::print_report_intersection(const Instruction& i) {
  define(i, fmt::format("k::reportIntersectionEXT(shader_call, {}, {})", value(i.operand(0)),
                        value_with_sign(i.operand(1), Sign::as_unsigned)));
  statement("if (shader_call.decision == k::HitDecision::terminate) ", ending());
}

void Printer::print_structure_at(const Instruction& i) {
  const std::uint32_t operand = i.operand(0);
  std::string address = value(operand);
  // Of what no instruction computes SPIRV-Cross knows no type.
  if (maybe_get<SPIRVariable>(operand) != nullptr || maybe_get<SPIRConstant>(operand) != nullptr)
    return define(i, fmt::format("k::structure_at({})", address));
  // Where it hoists the result it declares a variable of the operand's type.
  if (hoisted_temporaries.contains(i.result())) {
    statement(to_name(i.result()), " = ", address, ";");
    address = to_name(i.result());
  }
  set<SPIRExpression>(i.result(), fmt::format("k::structure_at({})", address), i.result_type(), true);
}

void Printer::print_ignore_intersection(const Instruction&) {
  statement("shader_call.decision = k::HitDecision::ignore;");
  statement(ending());
}

void Printer::print_terminate_ray(const Instruction&) {
  statement("shader_call.decision = k::HitDecision::terminate;");
  statement(ending());
}

std::string Printer::traced_built_in(spv::BuiltIn built_in) const {
  switch (built_in) {
    case spv::BuiltInLaunchIdKHR:
      return "k::launch_id(shader_call)";
    case spv::BuiltInLaunchSizeKHR:
      return "k::launch_size(shader_call)";
    default:
      break;
  }
  const rhi::ShaderStage stage = reflection_.stage;
  const bool has_hit = stage == rhi::ShaderStage::any_hit || stage == rhi::ShaderStage::closest_hit ||
                       stage == rhi::ShaderStage::intersection;
  if (has_hit || stage == rhi::ShaderStage::miss) {
    switch (built_in) {
      case spv::BuiltInWorldRayOriginKHR:
        return "k::world_ray_origin(shader_call)";
      case spv::BuiltInWorldRayDirectionKHR:
        return "k::world_ray_direction(shader_call)";
      case spv::BuiltInRayTminKHR:
        return "shader_call.ray->t_min";
      case spv::BuiltInRayTmaxKHR:
        return "shader_call.t";
      case spv::BuiltInIncomingRayFlagsKHR:
        return "shader_call.ray->flags";
      case spv::BuiltInCullMaskKHR:
        return "shader_call.ray->mask";
      default:
        break;
    }
  }
  if (has_hit) {
    switch (built_in) {
      case spv::BuiltInInstanceId:
        return "shader_call.hit->instance_index";
      case spv::BuiltInInstanceCustomIndexKHR:
        return "shader_call.instance->custom_index";
      case spv::BuiltInRayGeometryIndexKHR:
        return "shader_call.hit->geometry_index";
      case spv::BuiltInPrimitiveId:
        return "shader_call.hit->primitive_index";
      case spv::BuiltInObjectRayOriginKHR:
        return "k::object_ray_origin(shader_call)";
      case spv::BuiltInObjectRayDirectionKHR:
        return "k::object_ray_direction(shader_call)";
      case spv::BuiltInObjectToWorldKHR:
        return "k::columns_of(shader_call.instance->object_to_world)";
      case spv::BuiltInWorldToObjectKHR:
        return "k::columns_of(shader_call.instance->world_to_object)";
      case spv::BuiltInHitKindKHR:
        return "shader_call.hit_kind";
      default:
        break;
    }
  }
  fail("built-in " + rhi::built_in_name(built_in) + " in this shader stage");
}

}  // namespace tandem::cpu
