#include "rhi_cpu/compute_pipeline.hpp"

namespace tandem::cpu {

ComputePipeline::ComputePipeline(DeviceStateHandle device, const rhi::ComputePipelineDesc& desc)
    : rhi::ComputePipeline(desc),
      device_(std::move(device)),
      kernel_(device_->kernels.kernel(*desc.shader, desc.specialization, desc.label, desc.required_subgroup_size)) {}

}  // namespace tandem::cpu
