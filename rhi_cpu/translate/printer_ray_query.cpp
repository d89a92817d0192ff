#include <fmt/format.h>

#include "rhi_cpu/translate/printer.hpp"

namespace tandem::cpu {

using spirv_cross::SPIRConstant;

void Printer::print_ray_query(spv::Op op, Operands ops) {
  const auto getter = [&](const char* name, bool takes_intersection) {
    std::string text = fmt::format("k::rayQueryGet{}EXT({}", name, value(ops[2]));
    // The operand is a constant: 0 the candidate, 1 the committed intersection.
    if (takes_intersection) text += get<SPIRConstant>(ops[3]).scalar() != 0 ? ", true" : ", false";
    define(ops[0], ops[1], fmt::format("{}({}))", type_name(ops[0]), text));
  };
  switch (op) {
    case spv::OpRayQueryInitializeKHR:
      statement(fmt::format("k::rayQueryInitializeEXT({}, {}, {}, {}, {}, {}, {}, {});", value(ops[0]), value(ops[1]),
                            value_unsigned(ops[2]), value_unsigned(ops[3]), value(ops[4]), value(ops[5]), value(ops[6]),
                            value(ops[7])));
      return;
    case spv::OpRayQueryTerminateKHR:
      statement("k::rayQueryTerminateEXT(", value(ops[0]), ");");
      return;
    case spv::OpRayQueryConfirmIntersectionKHR:
      statement("k::rayQueryConfirmIntersectionEXT(", value(ops[0]), ");");
      return;
    case spv::OpRayQueryGenerateIntersectionKHR:
      statement("k::rayQueryGenerateIntersectionEXT(", value(ops[0]), ", ", value(ops[1]), ");");
      return;
    case spv::OpRayQueryGetIntersectionCandidateAABBOpaqueKHR:
      return getter("IntersectionCandidateAABBOpaque", false);
    case spv::OpRayQueryProceedKHR:
      return define(ops[0], ops[1], fmt::format("k::rayQueryProceedEXT({})", value(ops[2])));
    case spv::OpRayQueryGetRayTMinKHR:
      return getter("RayTMin", false);
    case spv::OpRayQueryGetRayFlagsKHR:
      return getter("RayFlags", false);
    case spv::OpRayQueryGetWorldRayDirectionKHR:
      return getter("WorldRayDirection", false);
    case spv::OpRayQueryGetWorldRayOriginKHR:
      return getter("WorldRayOrigin", false);
    case spv::OpRayQueryGetIntersectionTypeKHR:
      return getter("IntersectionType", true);
    case spv::OpRayQueryGetIntersectionTKHR:
      return getter("IntersectionT", true);
    case spv::OpRayQueryGetIntersectionInstanceCustomIndexKHR:
      return getter("IntersectionInstanceCustomIndex", true);
    case spv::OpRayQueryGetIntersectionInstanceIdKHR:
      return getter("IntersectionInstanceId", true);
    case spv::OpRayQueryGetIntersectionInstanceShaderBindingTableRecordOffsetKHR:
      return getter("IntersectionInstanceShaderBindingTableRecordOffset", true);
    case spv::OpRayQueryGetIntersectionGeometryIndexKHR:
      return getter("IntersectionGeometryIndex", true);
    case spv::OpRayQueryGetIntersectionPrimitiveIndexKHR:
      return getter("IntersectionPrimitiveIndex", true);
    case spv::OpRayQueryGetIntersectionBarycentricsKHR:
      return getter("IntersectionBarycentrics", true);
    case spv::OpRayQueryGetIntersectionFrontFaceKHR:
      return getter("IntersectionFrontFace", true);
    case spv::OpRayQueryGetIntersectionObjectRayDirectionKHR:
      return getter("IntersectionObjectRayDirection", true);
    case spv::OpRayQueryGetIntersectionObjectRayOriginKHR:
      return getter("IntersectionObjectRayOrigin", true);
    case spv::OpRayQueryGetIntersectionObjectToWorldKHR:
      return getter("IntersectionObjectToWorld", true);
    case spv::OpRayQueryGetIntersectionWorldToObjectKHR:
      return getter("IntersectionWorldToObject", true);
    default:
      fail(fmt::format("SPIR-V opcode {}", static_cast<std::uint32_t>(op)));
  }
}

}  // namespace tandem::cpu
