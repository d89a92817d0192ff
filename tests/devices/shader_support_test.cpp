#include "devices/shader_support.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <iterator>
#include <set>
#include <string>
#include <vector>

#include "devices/devices.hpp"
#include "rhi/spirv/names.hpp"
#include "rhi_cpu/translate/supported.hpp"
#include "rhi_vulkan/shader_capabilities.hpp"

namespace tandem {
namespace {

std::set<std::string> names_of(const std::vector<std::uint32_t>& numbers) {
  std::set<std::string> names;
  for (const std::uint32_t number : numbers) names.insert(rhi::capability_name(number));
  return names;
}

std::set<std::string> difference(const std::set<std::string>& a, const std::set<std::string>& b) {
  std::set<std::string> result;
  std::set_difference(a.begin(), a.end(), b.begin(), b.end(), std::inserter(result, result.begin()));
  return result;
}

TEST_CASE("Both backends know the same capabilities, but for those that the CPU devices have yet to learn") {
  const std::set<std::string> cpu = names_of(cpu::supported_capabilities());
  const std::set<std::string> vulkan = names_of(vulkan::known_capabilities());
  // A promise to compilers, whose feature Debian 12's Vulkan headers do not know.
  CHECK(difference(cpu, vulkan) == std::set<std::string>{"ExpectAssumeKHR", "SubgroupBallotKHR", "SubgroupVoteKHR"});
  // Other ways to round.
  CHECK(difference(vulkan, cpu) == std::set<std::string>{"DenormFlushToZero", "RoundingModeRTZ"});
}

TEST_CASE("The document names every capability of every device, and every format") {
  const std::vector<rhi::DeviceInfo> devices = enumerate_devices();
  const std::string text = shader_support_markdown(devices);
  for (const rhi::DeviceInfo& device : devices) {
    CHECK(text.find("`" + device.name + "`") != std::string::npos);
    REQUIRE_FALSE(device.spirv_capabilities.empty());
    for (const std::uint32_t number : device.spirv_capabilities)
      CHECK(text.find("\n| " + rhi::capability_name(number) + " | ") != std::string::npos);
  }
  for (std::size_t i = 0; i < rhi::texture_format_count; ++i)
    CHECK(text.find("\n| " + std::string(rhi::info_of(static_cast<rhi::TextureFormat>(i)).name) + " | ") !=
          std::string::npos);
  CHECK(text.find("- Built-ins: ") != std::string::npos);
  CHECK(text.find("LaunchIdKHR") != std::string::npos);
}

}  // namespace
}  // namespace tandem
