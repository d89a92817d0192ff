#include "rhi_cpu/translate/supported.hpp"

#include <algorithm>
#include <cstring>
#include <iterator>
#include <map>
#include <vector>

#include <fmt/format.h>

#include "rhi/error.hpp"
#include "rhi/spirv/names.hpp"
#include "rhi/spirv/words.hpp"
#include "rhi_cpu/translate/instructions/extended_instructions.hpp"
#include "rhi_cpu/translate/printer.hpp"
#include "rhi_cpu/translate/refusal.hpp"

namespace tandem::cpu {
namespace {

constexpr spv::Capability capabilities[] = {spv::CapabilityMatrix,
                                            spv::CapabilityShader,
                                            spv::CapabilityInt64,
                                            spv::CapabilityInt64Atomics,
                                            spv::CapabilityInt16,
                                            spv::CapabilityInt8,
                                            spv::CapabilityFloat64,
                                            spv::CapabilityFloat16,
                                            spv::CapabilityStorageBuffer16BitAccess,
                                            spv::CapabilityUniformAndStorageBuffer16BitAccess,
                                            spv::CapabilityStoragePushConstant16,
                                            spv::CapabilityStorageBuffer8BitAccess,
                                            spv::CapabilityUniformAndStorageBuffer8BitAccess,
                                            spv::CapabilityStoragePushConstant8,
                                            spv::CapabilityUniformBufferArrayDynamicIndexing,
                                            spv::CapabilityStorageBufferArrayDynamicIndexing,
                                            spv::CapabilityShaderNonUniform,
                                            spv::CapabilityRuntimeDescriptorArray,
                                            spv::CapabilityPhysicalStorageBufferAddresses,
                                            spv::CapabilityImage1D,
                                            spv::CapabilityImageCubeArray,
                                            spv::CapabilitySampled1D,
                                            spv::CapabilitySampledCubeArray,
                                            spv::CapabilitySampledBuffer,
                                            spv::CapabilityImageGatherExtended,
                                            spv::CapabilityMinLod,
                                            spv::CapabilitySampledImageArrayDynamicIndexing,
                                            spv::CapabilitySampledImageArrayNonUniformIndexing,
                                            spv::CapabilityUniformTexelBufferArrayDynamicIndexing,
                                            spv::CapabilityUniformTexelBufferArrayNonUniformIndexing,
                                            spv::CapabilityImageBuffer,
                                            spv::CapabilityInt64ImageEXT,
                                            spv::CapabilityImageQuery,
                                            spv::CapabilityStorageImageExtendedFormats,
                                            spv::CapabilityStorageImageReadWithoutFormat,
                                            spv::CapabilityStorageImageWriteWithoutFormat,
                                            spv::CapabilityStorageImageArrayDynamicIndexing,
                                            spv::CapabilityStorageImageArrayNonUniformIndexing,
                                            spv::CapabilityStorageTexelBufferArrayDynamicIndexing,
                                            spv::CapabilityStorageTexelBufferArrayNonUniformIndexing,
                                            spv::CapabilityUniformBufferArrayNonUniformIndexing,
                                            spv::CapabilityStorageBufferArrayNonUniformIndexing,
                                            spv::CapabilitySignedZeroInfNanPreserve,
                                            spv::CapabilityDenormPreserve,
                                            spv::CapabilityRoundingModeRTE,
                                            spv::CapabilityVulkanMemoryModel,
                                            spv::CapabilityVulkanMemoryModelDeviceScope,
                                            spv::CapabilityAtomicFloat32AddEXT,
                                            spv::CapabilityAtomicFloat64AddEXT,
                                            spv::CapabilityAtomicFloat16AddEXT,
                                            spv::CapabilityAtomicFloat16MinMaxEXT,
                                            spv::CapabilityAtomicFloat32MinMaxEXT,
                                            spv::CapabilityAtomicFloat64MinMaxEXT,
                                            spv::CapabilityVariablePointers,
                                            spv::CapabilityVariablePointersStorageBuffer,
                                            spv::CapabilityDotProduct,
                                            spv::CapabilityDotProductInputAll,
                                            spv::CapabilityDotProductInput4x8Bit,
                                            spv::CapabilityDotProductInput4x8BitPacked,
                                            spv::CapabilityShaderClockKHR,
                                            spv::CapabilityExpectAssumeKHR,
                                            spv::CapabilityRayQueryKHR,
                                            spv::CapabilityRayTracingKHR,
                                            spv::CapabilityRayCullMaskKHR,
                                            spv::CapabilityRayTraversalPrimitiveCullingKHR,
                                            spv::CapabilityWorkgroupMemoryExplicitLayoutKHR,
                                            spv::CapabilityWorkgroupMemoryExplicitLayout8BitAccessKHR,
                                            spv::CapabilityWorkgroupMemoryExplicitLayout16BitAccessKHR,
                                            spv::CapabilityGroupNonUniform,
                                            spv::CapabilityGroupNonUniformVote,
                                            spv::CapabilityGroupNonUniformArithmetic,
                                            spv::CapabilityGroupNonUniformBallot,
                                            spv::CapabilityGroupNonUniformShuffle,
                                            spv::CapabilityGroupNonUniformShuffleRelative,
                                            spv::CapabilityGroupNonUniformClustered,
                                            spv::CapabilityGroupNonUniformQuad,
                                            spv::CapabilityGroupNonUniformRotateKHR,
                                            spv::CapabilitySubgroupBallotKHR,
                                            spv::CapabilitySubgroupVoteKHR};

/// Those of them that no stage of a ray tracing pipeline has.
constexpr spv::Capability compute_capabilities[] = {spv::CapabilityGroupNonUniform,
                                                    spv::CapabilityGroupNonUniformVote,
                                                    spv::CapabilityGroupNonUniformArithmetic,
                                                    spv::CapabilityGroupNonUniformBallot,
                                                    spv::CapabilityGroupNonUniformShuffle,
                                                    spv::CapabilityGroupNonUniformShuffleRelative,
                                                    spv::CapabilityGroupNonUniformClustered,
                                                    spv::CapabilityGroupNonUniformQuad,
                                                    spv::CapabilityGroupNonUniformRotateKHR,
                                                    spv::CapabilitySubgroupBallotKHR,
                                                    spv::CapabilitySubgroupVoteKHR};

constexpr spv::ExecutionModel execution_models[] = {spv::ExecutionModelGLCompute,  spv::ExecutionModelRayGenerationKHR,
                                                    spv::ExecutionModelAnyHitKHR,  spv::ExecutionModelClosestHitKHR,
                                                    spv::ExecutionModelMissKHR,    spv::ExecutionModelIntersectionKHR,
                                                    spv::ExecutionModelCallableKHR};

constexpr spv::ExecutionMode execution_modes[] = {spv::ExecutionModeLocalSize, spv::ExecutionModeLocalSizeId,
                                                  spv::ExecutionModeSignedZeroInfNanPreserve,
                                                  spv::ExecutionModeDenormPreserve, spv::ExecutionModeRoundingModeRTE,
                                                  spv::ExecutionModeSubgroupUniformControlFlowKHR,
                                                  // MaximallyReconvergesKHR, which Debian 12's header does not know.
                                                  static_cast<spv::ExecutionMode>(6023)};

constexpr spv::StorageClass storage_classes[] = {
    spv::StorageClassUniformConstant, spv::StorageClassInput,
    spv::StorageClassUniform,         spv::StorageClassPrivate,
    spv::StorageClassWorkgroup,       spv::StorageClassFunction,
    spv::StorageClassPushConstant,    spv::StorageClassStorageBuffer,
    spv::StorageClassRayPayloadKHR,   spv::StorageClassIncomingRayPayloadKHR,
    spv::StorageClassCallableDataKHR, spv::StorageClassIncomingCallableDataKHR,
    spv::StorageClassHitAttributeKHR, spv::StorageClassShaderRecordBufferKHR,
    spv::StorageClassImage,           spv::StorageClassPhysicalStorageBuffer};

constexpr spv::BuiltIn built_ins[] = {spv::BuiltInNumWorkgroups,
                                      spv::BuiltInWorkgroupSize,
                                      spv::BuiltInWorkgroupId,
                                      spv::BuiltInLocalInvocationId,
                                      spv::BuiltInGlobalInvocationId,
                                      spv::BuiltInLocalInvocationIndex,
                                      spv::BuiltInLaunchIdKHR,
                                      spv::BuiltInLaunchSizeKHR,
                                      spv::BuiltInInstanceId,
                                      spv::BuiltInInstanceCustomIndexKHR,
                                      spv::BuiltInRayGeometryIndexKHR,
                                      spv::BuiltInPrimitiveId,
                                      spv::BuiltInWorldRayOriginKHR,
                                      spv::BuiltInWorldRayDirectionKHR,
                                      spv::BuiltInObjectRayOriginKHR,
                                      spv::BuiltInObjectRayDirectionKHR,
                                      spv::BuiltInRayTminKHR,
                                      spv::BuiltInRayTmaxKHR,
                                      spv::BuiltInHitKindKHR,
                                      spv::BuiltInObjectToWorldKHR,
                                      spv::BuiltInWorldToObjectKHR,
                                      spv::BuiltInIncomingRayFlagsKHR,
                                      spv::BuiltInCullMaskKHR,
                                      spv::BuiltInSubgroupSize,
                                      spv::BuiltInNumSubgroups,
                                      spv::BuiltInSubgroupId,
                                      spv::BuiltInSubgroupLocalInvocationId,
                                      spv::BuiltInSubgroupEqMask,
                                      spv::BuiltInSubgroupGeMask,
                                      spv::BuiltInSubgroupGtMask,
                                      spv::BuiltInSubgroupLeMask,
                                      spv::BuiltInSubgroupLtMask};

constexpr spv::Dim dimensions[] = {spv::Dim1D, spv::Dim2D, spv::Dim3D, spv::DimCube, spv::DimBuffer};

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
    spv::DecorationRestrictPointer,  spv::DecorationUniform,       spv::DecorationFPRoundingMode,
    spv::DecorationUniformId,        spv::DecorationUserSemantic,  spv::DecorationUserTypeGOOGLE,
    spv::DecorationCounterBuffer};

/// Those that SPIRV-Cross makes declarations and control flow of; of every other one, Printer makes C++.
constexpr spv::Op structural_instructions[] = {
    spv::OpSourceContinued, spv::OpSource, spv::OpSourceExtension, spv::OpName, spv::OpMemberName, spv::OpString,
    spv::OpModuleProcessed, spv::OpExtension, spv::OpExtInstImport, spv::OpMemoryModel, spv::OpEntryPoint,
    spv::OpExecutionMode, spv::OpExecutionModeId, spv::OpCapability, spv::OpDecorate, spv::OpDecorateId,
    spv::OpMemberDecorate, spv::OpDecorateString, spv::OpMemberDecorateString, spv::OpDecorationGroup,
    spv::OpGroupDecorate, spv::OpGroupMemberDecorate,
    // types and constants
    spv::OpTypeVoid, spv::OpTypeBool, spv::OpTypeInt, spv::OpTypeFloat, spv::OpTypeVector, spv::OpTypeMatrix,
    spv::OpTypeArray, spv::OpTypeRuntimeArray, spv::OpTypeStruct, spv::OpTypeForwardPointer, spv::OpTypePointer,
    spv::OpTypeFunction, spv::OpTypeImage, spv::OpTypeSampler, spv::OpTypeSampledImage,
    spv::OpTypeAccelerationStructureKHR, spv::OpTypeRayQueryKHR, spv::OpUndef, spv::OpConstantTrue,
    spv::OpConstantFalse, spv::OpConstant, spv::OpConstantComposite, spv::OpConstantNull, spv::OpSpecConstantTrue,
    spv::OpSpecConstantFalse, spv::OpSpecConstant, spv::OpSpecConstantComposite, spv::OpSpecConstantOp,
    // variables and control flow
    spv::OpVariable, spv::OpFunction, spv::OpFunctionParameter, spv::OpFunctionEnd, spv::OpPhi, spv::OpLoopMerge,
    spv::OpSelectionMerge, spv::OpLabel, spv::OpBranch, spv::OpBranchConditional, spv::OpSwitch, spv::OpReturn,
    spv::OpReturnValue, spv::OpUnreachable};

template <typename T, std::size_t size>
bool contains(const T (&known)[size], std::uint32_t value) {
  return std::any_of(std::begin(known), std::end(known),
                     [=](T each) { return static_cast<std::uint32_t>(each) == value; });
}

std::string literal_string(std::span<const std::uint32_t> words) {
  const auto* characters = reinterpret_cast<const char*>(words.data());
  return {characters, strnlen(characters, words.size_bytes())};
}

class Checker {
 public:
  /// Each thing once, in the order of the module.
  const std::vector<std::string>& unsupported() const { return unsupported_; }

  void check(std::span<const std::uint32_t> i) {
    // The module is not validated yet: an instruction may be too short.
    const auto word = [i](std::size_t k) { return k < i.size() ? i[k] : 0u; };
    const auto op = static_cast<spv::Op>(word(0) & 0xffff);
    if (!is_supported(op)) fail(rhi::instruction_name(op, i.subspan(1)));
    switch (op) {
      case spv::OpCapability:
        if (!contains(capabilities, word(1))) fail("capability " + rhi::capability_name(word(1)));
        if (contains(compute_capabilities, word(1))) of_compute_.push_back(word(1));
        break;
      case spv::OpExtInstImport:
        import(word(1), literal_string(i.subspan(std::min<std::size_t>(2, i.size()))));
        break;
      case spv::OpEntryPoint:
        model_ = word(1);
        if (!contains(execution_models, model_)) fail("execution model " + rhi::execution_model_name(model_));
        if (model_ != spv::ExecutionModelGLCompute)
          for (const std::uint32_t capability : of_compute_)
            fail(fmt::format("capability {} in a ray tracing stage", rhi::capability_name(capability)));
        break;
      case spv::OpExecutionMode:
      case spv::OpExecutionModeId:
        if (!contains(execution_modes, word(2))) fail("execution mode " + rhi::execution_mode_name(word(2)));
        break;
      case spv::OpTypeImage:
        check_image(word(3), word(6), word(7));
        break;
      case spv::OpTypePointer:
        if (!contains(storage_classes, word(2))) fail("storage class " + rhi::storage_class_name(word(2)));
        break;
      case spv::OpTypeFloat:
        if (word(2) != 16 && word(2) != 32 && word(2) != 64) fail(fmt::format("OpTypeFloat {}", word(2)));
        break;
      case spv::OpDecorate:
      case spv::OpDecorateId:
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
  void fail(const std::string& what) {
    if (std::find(unsupported_.begin(), unsupported_.end(), what) == unsupported_.end()) unsupported_.push_back(what);
  }

  void import(std::uint32_t id, const std::string& name) {
    if (name != "GLSL.std.450" && !name.starts_with("NonSemantic.")) fail("extended instruction set " + name);
    sets_[id] = name;
  }

  void check_image(std::uint32_t dimension, std::uint32_t multisampled, std::uint32_t sampled) {
    if (sampled != 1 && sampled != 2) fail("OpTypeImage that may be sampled or not");
    if (multisampled != 0) fail("OpTypeImage with several samples");
    if (!contains(dimensions, dimension)) fail("OpTypeImage of dimension " + rhi::dimension_name(dimension));
  }

  void check_decoration(std::uint32_t decoration, std::uint32_t operand) {
    // Of a payload or a hit attribute, which its variable names too.
    if (decoration == spv::DecorationLocation && model_ != spv::ExecutionModelGLCompute) return;
    if (decoration == spv::DecorationFPRoundingMode && operand != spv::FPRoundingModeRTE &&
        operand != spv::FPRoundingModeRTZ)
      fail("rounding to an infinity");
    if (!contains(decorations, decoration)) fail("decoration " + rhi::decoration_name(decoration));
    if (decoration == spv::DecorationBuiltIn && !contains(built_ins, operand))
      fail("built-in " + rhi::built_in_name(operand));
  }

  void check_extended(std::uint32_t set_id, std::uint32_t instruction) {
    const auto set = sets_.find(set_id);
    if (set == sets_.end()) return fail("an extended instruction of an unknown set");
    if (set->second != "GLSL.std.450") return;  // NonSemantic: may be ignored
    if (find_extended(instruction) == nullptr)
      fail("extended instruction " + rhi::extended_instruction_name(instruction));
  }

  std::vector<std::string> unsupported_;
  std::map<std::uint32_t, std::string> sets_;
  std::uint32_t model_ = spv::ExecutionModelGLCompute;
  std::vector<std::uint32_t> of_compute_;  ///< declared capabilities of compute_capabilities
};

}  // namespace

ShaderSupport shader_support() {
  ShaderSupport support;
  const auto list = [](std::vector<std::string>& names, const auto& values, auto name) {
    for (const auto value : values) names.push_back(name(static_cast<std::uint32_t>(value)));
    std::sort(names.begin(), names.end());
  };
  list(support.storage_classes, storage_classes, rhi::storage_class_name);
  list(support.built_ins, built_ins, rhi::built_in_name);
  list(support.execution_models, execution_models, rhi::execution_model_name);
  list(support.execution_modes, execution_modes, rhi::execution_mode_name);
  list(support.decorations, decorations, rhi::decoration_name);
  return support;
}

std::vector<std::uint32_t> supported_capabilities() {
  std::vector<std::uint32_t> numbers;
  for (const spv::Capability capability : capabilities) numbers.push_back(capability);
  std::sort(numbers.begin(), numbers.end());
  return numbers;
}

bool is_supported(spv::Op op) { return contains(structural_instructions, op) || Printer::prints(op); }

std::vector<std::string> unsupported_features(std::span<const std::uint32_t> spirv, const std::string& label) {
  Checker checker;
  for (std::size_t i = rhi::spirv_header_words; i < spirv.size();) {
    const std::size_t length = spirv[i] >> 16;
    if (length == 0 || i + length > spirv.size())
      throw rhi::Error(rhi::ErrorCode::invalid_argument, label, "the SPIR-V is truncated");
    checker.check(spirv.subspan(i, length));
    i += length;
  }
  return checker.unsupported();
}

namespace {

template <typename Is>
bool declares(std::span<const std::uint32_t> spirv, const Is& is) {
  bool found = false;
  rhi::for_each_instruction(
      spirv, [&](std::span<const std::uint32_t> i) { found |= rhi::operation_of(i) == spv::OpCapability && is(i[1]); });
  return found;
}

}  // namespace

bool declares_subgroups(std::span<const std::uint32_t> spirv) {
  return declares(spirv, [](std::uint32_t capability) { return contains(compute_capabilities, capability); });
}

bool declares_ray_queries(std::span<const std::uint32_t> spirv) {
  return declares(spirv, [](std::uint32_t capability) { return capability == spv::CapabilityRayQueryKHR; });
}

void check_supported(std::span<const std::uint32_t> spirv, const std::string& label) {
  const std::vector<std::string> features = unsupported_features(spirv, label);
  if (features.empty()) return;
  std::string all;
  for (std::size_t i = 0; i < features.size(); ++i)
    all += (i == 0 ? "" : i + 1 == features.size() ? " and " : ", ") + features[i];
  if (features.size() == 1) refuse(label, all);
  throw rhi::Error(rhi::ErrorCode::unsupported, label, all + " are not supported by the CPU device");
}

}  // namespace tandem::cpu
