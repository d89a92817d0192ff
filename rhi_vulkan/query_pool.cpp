#include "rhi_vulkan/query_pool.hpp"

#include <algorithm>
#include <cstdint>
#include <utility>

namespace tandem::vulkan {

QueryPool::QueryPool(ContextHandle context, const rhi::QueryPoolDesc& desc)
    : rhi::QueryPool(desc), context_(std::move(context)), submitted_(desc.count) {
  if (context_->physical.timestamp_valid_bits == 0)
    throw rhi::Error(rhi::ErrorCode::unsupported, desc.label,
                     "device '" + context_->physical.info.name + "' keeps no timestamps");
  translating_errors(desc.label, "create the query pool", [&] {
    pool_ = context_->device.createQueryPool({.queryType = vk::QueryType::eTimestamp, .queryCount = desc.count});
    context_->name(pool_, desc.label);
  });
}

std::vector<double> QueryPool::timestamps_ns() const {
  const auto never_written = std::find(submitted_.begin(), submitted_.end(), false);
  if (never_written != submitted_.end())
    throw rhi::Error(rhi::ErrorCode::invalid_argument, desc().label,
                     "query " + std::to_string(never_written - submitted_.begin()) + " was never written");
  const std::size_t count = desc().count;
  const auto [result, ticks] = translating_errors(desc().label, "read the timestamps", [&] {
    return pool_.getResults<std::uint64_t>(0, desc().count, count * sizeof(std::uint64_t), sizeof(std::uint64_t),
                                           vk::QueryResultFlagBits::e64);
  });
  if (result != vk::Result::eSuccess)
    throw rhi::Error(rhi::ErrorCode::invalid_argument, desc().label,
                     "the submission that writes the timestamps has not executed yet");

  // Counted from the first timestamp that anyone read: a double has 53 bits, a clock that began in 1970 fills 61 of
  // them.
  std::uint64_t epoch = 0;
  if (context_->timestamp_epoch.compare_exchange_strong(epoch, ticks.front())) epoch = ticks.front();
  const std::uint32_t unused_bits = 64 - std::min(context_->physical.timestamp_valid_bits, 64u);
  std::vector<double> nanoseconds;
  for (const std::uint64_t tick : ticks) {
    // Shifted up and down again, so that the highest valid bit is the sign: earlier than the epoch is negative.
    const auto since_epoch = static_cast<std::int64_t>((tick - epoch) << unused_bits) >> unused_bits;
    nanoseconds.push_back(static_cast<double>(since_epoch) * context_->physical.timestamp_period);
  }
  return nanoseconds;
}

}  // namespace tandem::vulkan
