#include "rhi_cpu/translate/supported.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <sstream>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <spirv_cross/GLSL.std.450.h>
#include <spirv-tools/libspirv.hpp>
#include <spirv_cross/spirv.hpp>

#include "rhi/error.hpp"

namespace tandem::cpu {
namespace {

constexpr std::size_t header_words = 5;

constexpr spv::Capability capabilities[] = {spv::CapabilityMatrix,
                                            spv::CapabilityShader,
                                            spv::CapabilityInt64,
                                            spv::CapabilityInt64Atomics,
                                            spv::CapabilityInt16,
                                            spv::CapabilityInt8,
                                            spv::CapabilityFloat64,
                                            spv::CapabilityStorageBuffer16BitAccess,
                                            spv::CapabilityUniformAndStorageBuffer16BitAccess,
                                            spv::CapabilityStoragePushConstant16,
                                            spv::CapabilityStorageBuffer8BitAccess,
                                            spv::CapabilityUniformAndStorageBuffer8BitAccess,
                                            spv::CapabilityStoragePushConstant8,
                                            spv::CapabilityUniformBufferArrayDynamicIndexing,
                                            spv::CapabilityStorageBufferArrayDynamicIndexing,
                                            spv::CapabilityShaderNonUniform,
                                            spv::CapabilityPhysicalStorageBufferAddresses,
                                            spv::CapabilityImage1D,
                                            spv::CapabilityImageQuery,
                                            spv::CapabilityStorageImageExtendedFormats,
                                            spv::CapabilityStorageImageReadWithoutFormat,
                                            spv::CapabilityStorageImageWriteWithoutFormat,
                                            spv::CapabilityStorageImageArrayDynamicIndexing,
                                            spv::CapabilityStorageImageArrayNonUniformIndexing,
                                            spv::CapabilityUniformBufferArrayNonUniformIndexing,
                                            spv::CapabilityStorageBufferArrayNonUniformIndexing,
                                            spv::CapabilitySignedZeroInfNanPreserve,
                                            spv::CapabilityDenormPreserve,
                                            spv::CapabilityRoundingModeRTE,
                                            spv::CapabilityVulkanMemoryModel,
                                            spv::CapabilityVulkanMemoryModelDeviceScope,
                                            spv::CapabilityAtomicFloat32AddEXT,
                                            spv::CapabilityAtomicFloat64AddEXT,
                                            spv::CapabilityRayQueryKHR,
                                            spv::CapabilityRayTracingKHR,
                                            spv::CapabilityRayCullMaskKHR,
                                            spv::CapabilityRayTraversalPrimitiveCullingKHR};

constexpr spv::ExecutionModel execution_models[] = {spv::ExecutionModelGLCompute,  spv::ExecutionModelRayGenerationKHR,
                                                    spv::ExecutionModelAnyHitKHR,  spv::ExecutionModelClosestHitKHR,
                                                    spv::ExecutionModelMissKHR,    spv::ExecutionModelIntersectionKHR,
                                                    spv::ExecutionModelCallableKHR};

constexpr spv::ExecutionMode execution_modes[] = {spv::ExecutionModeLocalSize, spv::ExecutionModeLocalSizeId,
                                                  spv::ExecutionModeSignedZeroInfNanPreserve,
                                                  spv::ExecutionModeDenormPreserve, spv::ExecutionModeRoundingModeRTE};

constexpr spv::StorageClass storage_classes[] = {spv::StorageClassUniformConstant,
                                                 spv::StorageClassInput,
                                                 spv::StorageClassUniform,
                                                 spv::StorageClassPrivate,
                                                 spv::StorageClassFunction,
                                                 spv::StorageClassPushConstant,
                                                 spv::StorageClassStorageBuffer,
                                                 spv::StorageClassRayPayloadKHR,
                                                 spv::StorageClassIncomingRayPayloadKHR,
                                                 spv::StorageClassCallableDataKHR,
                                                 spv::StorageClassIncomingCallableDataKHR,
                                                 spv::StorageClassHitAttributeKHR,
                                                 spv::StorageClassShaderRecordBufferKHR,
                                                 spv::StorageClassImage,
                                                 spv::StorageClassPhysicalStorageBuffer};

constexpr spv::BuiltIn built_ins[] = {spv::BuiltInNumWorkgroups,       spv::BuiltInWorkgroupSize,
                                      spv::BuiltInWorkgroupId,         spv::BuiltInLocalInvocationId,
                                      spv::BuiltInGlobalInvocationId,  spv::BuiltInLocalInvocationIndex,
                                      spv::BuiltInLaunchIdKHR,         spv::BuiltInLaunchSizeKHR,
                                      spv::BuiltInInstanceId,          spv::BuiltInInstanceCustomIndexKHR,
                                      spv::BuiltInRayGeometryIndexKHR, spv::BuiltInPrimitiveId,
                                      spv::BuiltInWorldRayOriginKHR,   spv::BuiltInWorldRayDirectionKHR,
                                      spv::BuiltInObjectRayOriginKHR,  spv::BuiltInObjectRayDirectionKHR,
                                      spv::BuiltInRayTminKHR,          spv::BuiltInRayTmaxKHR,
                                      spv::BuiltInHitKindKHR,          spv::BuiltInObjectToWorldKHR,
                                      spv::BuiltInWorldToObjectKHR,    spv::BuiltInIncomingRayFlagsKHR,
                                      spv::BuiltInCullMaskKHR};

/// Those that mean something here, and those that promise or allow what a CPU does anyway.
constexpr spv::Decoration decorations[] = {
    spv::DecorationRelaxedPrecision, spv::DecorationSpecId,        spv::DecorationBlock,
    spv::DecorationBufferBlock,      spv::DecorationRowMajor,      spv::DecorationColMajor,
    spv::DecorationArrayStride,      spv::DecorationMatrixStride,  spv::DecorationBuiltIn,
    spv::DecorationInvariant,        spv::DecorationRestrict,      spv::DecorationAliased,
    spv::DecorationVolatile,         spv::DecorationCoherent,      spv::DecorationNonWritable,
    spv::DecorationNonReadable,      spv::DecorationBinding,       spv::DecorationDescriptorSet,
    spv::DecorationOffset,           spv::DecorationNoContraction, spv::DecorationNoSignedWrap,
    spv::DecorationNoUnsignedWrap,   spv::DecorationNonUniform,    spv::DecorationAliasedPointer,
    spv::DecorationRestrictPointer,  spv::DecorationUniform};

constexpr spv::Op instructions[] = {
    spv::OpNop, spv::OpSourceContinued, spv::OpSource, spv::OpSourceExtension, spv::OpName, spv::OpMemberName,
    spv::OpString, spv::OpLine, spv::OpNoLine, spv::OpModuleProcessed, spv::OpExtension, spv::OpExtInstImport,
    spv::OpExtInst, spv::OpMemoryModel, spv::OpEntryPoint, spv::OpExecutionMode, spv::OpExecutionModeId,
    spv::OpCapability, spv::OpDecorate, spv::OpMemberDecorate, spv::OpDecorateString, spv::OpMemberDecorateString,
    spv::OpDecorationGroup, spv::OpGroupDecorate, spv::OpGroupMemberDecorate,
    // types and constants
    spv::OpTypeVoid, spv::OpTypeBool, spv::OpTypeInt, spv::OpTypeFloat, spv::OpTypeVector, spv::OpTypeMatrix,
    spv::OpTypeArray, spv::OpTypeRuntimeArray, spv::OpTypeStruct, spv::OpTypeForwardPointer, spv::OpTypePointer,
    spv::OpTypeFunction, spv::OpTypeImage, spv::OpTypeAccelerationStructureKHR, spv::OpTypeRayQueryKHR, spv::OpUndef,
    spv::OpConstantTrue, spv::OpConstantFalse, spv::OpConstant, spv::OpConstantComposite, spv::OpConstantNull,
    spv::OpSpecConstantTrue, spv::OpSpecConstantFalse, spv::OpSpecConstant, spv::OpSpecConstantComposite,
    spv::OpSpecConstantOp,
    // control flow
    spv::OpFunction, spv::OpFunctionParameter, spv::OpFunctionEnd, spv::OpFunctionCall, spv::OpPhi, spv::OpLoopMerge,
    spv::OpSelectionMerge, spv::OpLabel, spv::OpBranch, spv::OpBranchConditional, spv::OpSwitch, spv::OpReturn,
    spv::OpReturnValue, spv::OpUnreachable,
    // memory
    spv::OpVariable, spv::OpLoad, spv::OpStore, spv::OpCopyMemory, spv::OpAccessChain, spv::OpInBoundsAccessChain,
    spv::OpArrayLength, spv::OpAtomicLoad, spv::OpAtomicStore, spv::OpAtomicExchange, spv::OpAtomicCompareExchange,
    spv::OpAtomicIIncrement, spv::OpAtomicIDecrement, spv::OpAtomicIAdd, spv::OpAtomicISub, spv::OpAtomicSMin,
    spv::OpAtomicUMin, spv::OpAtomicSMax, spv::OpAtomicUMax, spv::OpAtomicAnd, spv::OpAtomicOr, spv::OpAtomicXor,
    spv::OpAtomicFAddEXT, spv::OpMemoryBarrier,
    // images
    spv::OpImageRead, spv::OpImageWrite, spv::OpImageQuerySize, spv::OpImageTexelPointer,
    // composites
    spv::OpVectorExtractDynamic, spv::OpVectorInsertDynamic, spv::OpVectorShuffle, spv::OpCompositeConstruct,
    spv::OpCompositeExtract, spv::OpCompositeInsert, spv::OpCopyObject, spv::OpCopyLogical, spv::OpTranspose,
    // conversions
    spv::OpConvertFToU, spv::OpConvertFToS, spv::OpConvertSToF, spv::OpConvertUToF, spv::OpUConvert, spv::OpSConvert,
    spv::OpFConvert, spv::OpBitcast, spv::OpConvertPtrToU, spv::OpConvertUToPtr,
    spv::OpConvertUToAccelerationStructureKHR,
    // arithmetic
    spv::OpSNegate, spv::OpFNegate, spv::OpIAdd, spv::OpFAdd, spv::OpISub, spv::OpFSub, spv::OpIMul, spv::OpFMul,
    spv::OpUDiv, spv::OpSDiv, spv::OpFDiv, spv::OpUMod, spv::OpSRem, spv::OpSMod, spv::OpFRem, spv::OpFMod,
    spv::OpVectorTimesScalar, spv::OpMatrixTimesScalar, spv::OpVectorTimesMatrix, spv::OpMatrixTimesVector,
    spv::OpMatrixTimesMatrix, spv::OpOuterProduct, spv::OpDot, spv::OpIAddCarry, spv::OpISubBorrow, spv::OpUMulExtended,
    spv::OpSMulExtended,
    // logic and relations
    spv::OpAny, spv::OpAll, spv::OpIsNan, spv::OpIsInf, spv::OpLogicalEqual, spv::OpLogicalNotEqual, spv::OpLogicalOr,
    spv::OpLogicalAnd, spv::OpLogicalNot, spv::OpSelect, spv::OpIEqual, spv::OpINotEqual, spv::OpUGreaterThan,
    spv::OpSGreaterThan, spv::OpUGreaterThanEqual, spv::OpSGreaterThanEqual, spv::OpULessThan, spv::OpSLessThan,
    spv::OpULessThanEqual, spv::OpSLessThanEqual, spv::OpFOrdEqual, spv::OpFUnordEqual, spv::OpFOrdNotEqual,
    spv::OpFUnordNotEqual, spv::OpFOrdLessThan, spv::OpFUnordLessThan, spv::OpFOrdGreaterThan, spv::OpFUnordGreaterThan,
    spv::OpFOrdLessThanEqual, spv::OpFUnordLessThanEqual, spv::OpFOrdGreaterThanEqual, spv::OpFUnordGreaterThanEqual,
    // bits
    spv::OpShiftRightLogical, spv::OpShiftRightArithmetic, spv::OpShiftLeftLogical, spv::OpBitwiseOr, spv::OpBitwiseXor,
    spv::OpBitwiseAnd, spv::OpNot, spv::OpBitFieldInsert, spv::OpBitFieldSExtract, spv::OpBitFieldUExtract,
    spv::OpBitReverse, spv::OpBitCount,
    // ray tracing
    spv::OpTraceRayKHR, spv::OpExecuteCallableKHR, spv::OpReportIntersectionKHR, spv::OpIgnoreIntersectionKHR,
    spv::OpTerminateRayKHR,
    // ray queries
    spv::OpRayQueryInitializeKHR, spv::OpRayQueryTerminateKHR, spv::OpRayQueryConfirmIntersectionKHR,
    spv::OpRayQueryGenerateIntersectionKHR, spv::OpRayQueryGetIntersectionCandidateAABBOpaqueKHR,
    spv::OpRayQueryProceedKHR, spv::OpRayQueryGetIntersectionTypeKHR, spv::OpRayQueryGetRayTMinKHR,
    spv::OpRayQueryGetRayFlagsKHR, spv::OpRayQueryGetIntersectionTKHR,
    spv::OpRayQueryGetIntersectionInstanceCustomIndexKHR, spv::OpRayQueryGetIntersectionInstanceIdKHR,
    spv::OpRayQueryGetIntersectionInstanceShaderBindingTableRecordOffsetKHR,
    spv::OpRayQueryGetIntersectionGeometryIndexKHR, spv::OpRayQueryGetIntersectionPrimitiveIndexKHR,
    spv::OpRayQueryGetIntersectionBarycentricsKHR, spv::OpRayQueryGetIntersectionFrontFaceKHR,
    spv::OpRayQueryGetIntersectionObjectRayDirectionKHR, spv::OpRayQueryGetIntersectionObjectRayOriginKHR,
    spv::OpRayQueryGetWorldRayDirectionKHR, spv::OpRayQueryGetWorldRayOriginKHR,
    spv::OpRayQueryGetIntersectionObjectToWorldKHR, spv::OpRayQueryGetIntersectionWorldToObjectKHR};

template <typename T, std::size_t size>
bool contains(const T (&known)[size], std::uint32_t value) {
  return std::any_of(std::begin(known), std::end(known),
                     [=](T each) { return static_cast<std::uint32_t>(each) == value; });
}

/// The disassembler's text for these instructions, "" when it does not know them.
std::string disassemble(std::span<const std::uint32_t> instructions) {
  std::vector<std::uint32_t> module = {spv::MagicNumber, 0x00010600, 0, 0x00400000, 0};
  module.insert(module.end(), instructions.begin(), instructions.end());
  const spvtools::SpirvTools tools(SPV_ENV_UNIVERSAL_1_6);
  std::string text;
  if (!tools.Disassemble(module, &text, SPV_BINARY_TO_TEXT_OPTION_NO_HEADER)) return {};
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return text;
}

/// The last word of the disassembly of an instruction whose last operand is the enumerant to name.
std::string last_word(std::span<const std::uint32_t> instruction) {
  const std::string text = disassemble(instruction);
  return text.substr(text.rfind(' ') + 1);
}

std::string literal_string(std::span<const std::uint32_t> words) {
  const auto* characters = reinterpret_cast<const char*>(words.data());
  return {characters, strnlen(characters, words.size_bytes())};
}

/// The name of an instruction as the disassembler prints it, for example "OpImageWrite".
std::string instruction_name(std::span<const std::uint32_t> instruction) {
  std::istringstream text(disassemble(instruction));
  for (std::string word; text >> word;)
    if (word.starts_with("Op")) return word;
  return fmt::format("SPIR-V opcode {}", instruction[0] & 0xffff);
}

class Checker {
 public:
  explicit Checker(const std::string& label) : label_(label) {}

  void check(std::span<const std::uint32_t> i) {
    // The module is not validated yet: an instruction may be too short.
    const auto word = [i](std::size_t k) { return k < i.size() ? i[k] : 0u; };
    const auto op = static_cast<spv::Op>(word(0) & 0xffff);
    if (!contains(instructions, op)) fail(instruction_name(i));
    switch (op) {
      case spv::OpCapability:
        if (!contains(capabilities, word(1))) fail("capability " + last_word(i));
        break;
      case spv::OpExtInstImport:
        import(word(1), literal_string(i.subspan(std::min<std::size_t>(2, i.size()))));
        break;
      case spv::OpEntryPoint:
        model_ = word(1);
        if (!contains(execution_models, model_)) fail("execution model " + word_after_operation(i));
        break;
      case spv::OpExecutionMode:
      case spv::OpExecutionModeId:
        if (!contains(execution_modes, word(2))) {
          const std::uint32_t mode[] = {3u << 16 | spv::OpExecutionMode, word(1), word(2)};
          fail("execution mode " + last_word(mode));
        }
        break;
      case spv::OpTypeImage:
        check_image(word(3), word(5), word(6), word(7));
        break;
      case spv::OpTypePointer:
        check_storage_class(word(2));
        break;
      case spv::OpTypeFloat:
        if (word(2) != 32 && word(2) != 64) fail(fmt::format("OpTypeFloat {}", word(2)));
        break;
      case spv::OpDecorate:
        check_decoration(word(2), word(3));
        break;
      case spv::OpMemberDecorate:
        check_decoration(word(3), word(4));
        break;
      case spv::OpExtInst:
        check_extended(word(3), word(4));
        break;
      default:
        break;
    }
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw rhi::Error(rhi::ErrorCode::unsupported, label_, what + " is not supported by the CPU device");
  }

  static std::string word_after_operation(std::span<const std::uint32_t> i) {
    std::istringstream text(disassemble(i));
    std::string operation, word;
    text >> operation >> word;
    return word;
  }

  void import(std::uint32_t id, const std::string& name) {
    if (name != "GLSL.std.450" && !name.starts_with("NonSemantic.")) fail("extended instruction set " + name);
    sets_[id] = name;
  }

  void check_image(std::uint32_t dimension, std::uint32_t arrayed, std::uint32_t multisampled,
                   std::uint32_t sampled) const {
    if (sampled != 2) fail("OpTypeImage of an image that is sampled");
    if (multisampled != 0) fail("OpTypeImage with several samples");
    const bool known =
        dimension == spv::Dim2D || (arrayed == 0 && (dimension == spv::Dim1D || dimension == spv::Dim3D));
    if (!known) fail(fmt::format("OpTypeImage of dimension {}{}", dimension, arrayed != 0 ? ", arrayed," : ""));
  }

  void check_storage_class(std::uint32_t storage) const {
    if (contains(storage_classes, storage)) return;
    const std::uint32_t pointer[] = {4u << 16 | spv::OpTypePointer, 1, storage, 2};
    std::istringstream text(disassemble(pointer));
    std::string word, name;
    while (text >> word && word != "OpTypePointer") {
    }
    text >> name;
    fail("storage class " + name);
  }

  void check_decoration(std::uint32_t decoration, std::uint32_t operand) const {
    // Of a payload or a hit attribute, which its variable names too.
    if (decoration == spv::DecorationLocation && model_ != spv::ExecutionModelGLCompute) return;
    if (!contains(decorations, decoration)) {
      const std::uint32_t one[] = {3u << 16 | spv::OpDecorate, 1, decoration};
      const std::uint32_t two[] = {4u << 16 | spv::OpDecorate, 1, decoration, operand};
      std::string text = disassemble(one);
      if (text.empty()) text = disassemble(two);
      std::istringstream words(text);
      std::string operation, target, name;
      words >> operation >> target >> name;
      fail("decoration " + (name.empty() ? std::to_string(decoration) : name));
    }
    if (decoration == spv::DecorationBuiltIn && !contains(built_ins, operand)) {
      const std::uint32_t built_in[] = {4u << 16 | spv::OpDecorate, 1, decoration, operand};
      fail("built-in " + last_word(built_in));
    }
  }

  void check_extended(std::uint32_t set_id, std::uint32_t instruction) const {
    const auto set = sets_.find(set_id);
    if (set == sets_.end()) fail("an extended instruction of an unknown set");
    if (set->second != "GLSL.std.450") return;  // NonSemantic: may be ignored
    const bool interpolation =
        instruction >= GLSLstd450InterpolateAtCentroid && instruction <= GLSLstd450InterpolateAtOffset;
    if (instruction != 0 && instruction <= GLSLstd450NClamp && instruction != GLSLstd450IMix && !interpolation) return;
    const char* name = instruction == GLSLstd450InterpolateAtCentroid ? "InterpolateAtCentroid"
                       : instruction == GLSLstd450InterpolateAtSample ? "InterpolateAtSample"
                       : instruction == GLSLstd450InterpolateAtOffset ? "InterpolateAtOffset"
                       : instruction == GLSLstd450IMix                ? "IMix"
                                                                      : "of a number unknown";
    fail(fmt::format("extended instruction {} ({})", name, instruction));
  }

  const std::string& label_;
  std::map<std::uint32_t, std::string> sets_;
  std::uint32_t model_ = spv::ExecutionModelGLCompute;
};

}  // namespace

std::string folded_operation_name(std::span<const std::uint32_t> instruction) {
  std::istringstream text(disassemble(instruction));
  std::string word;
  while (text >> word && word != "OpSpecConstantOp") {
  }
  text >> word >> word;  // the type, then the operation
  return word;
}

void check_supported(std::span<const std::uint32_t> spirv, const std::string& label) {
  Checker checker(label);
  for (std::size_t i = header_words; i < spirv.size();) {
    const std::size_t length = spirv[i] >> 16;
    if (length == 0 || i + length > spirv.size())
      throw rhi::Error(rhi::ErrorCode::invalid_argument, label, "the SPIR-V is truncated");
    checker.check(spirv.subspan(i, length));
    i += length;
  }
}

}  // namespace tandem::cpu
