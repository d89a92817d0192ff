#include "rhi/build.hpp"

namespace tandem::rhi {

AccelerationStructureHandle build_bottom_level(Device& device, const BottomLevelDesc& desc) {
  AccelerationStructureHandle structure = device.create_bottom_level(desc);
  const CommandListHandle list = device.create_command_list("build of " + desc.label);
  list->build_bottom_level(structure, desc);
  device.submit(list);
  return structure;
}

AccelerationStructureHandle build_top_level(Device& device, const TopLevelDesc& desc) {
  AccelerationStructureHandle structure = device.create_top_level(desc);
  const CommandListHandle list = device.create_command_list("build of " + desc.label);
  list->build_top_level(structure, desc);
  device.submit(list);
  return structure;
}

}  // namespace tandem::rhi
