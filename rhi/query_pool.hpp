#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace tandem::rhi {

struct QueryPoolDesc {
  std::uint32_t count = 0;  ///< timestamps, > 0
  std::string label;
};

/// Timestamps that command lists write while they execute.
class QueryPool {
 public:
  virtual ~QueryPool() = default;
  QueryPool(const QueryPool&) = delete;
  QueryPool& operator=(const QueryPool&) = delete;

  const QueryPoolDesc& desc() const noexcept { return desc_; }

  /// The time of each query in nanoseconds on the device's own clock; only differences mean something. Call it when the
  /// fence of the submission that wrote them is complete. Throws Error(invalid_argument) when one was never written.
  virtual std::vector<double> timestamps_ns() const = 0;

 protected:
  explicit QueryPool(QueryPoolDesc desc) : desc_(std::move(desc)) {}

 private:
  QueryPoolDesc desc_;
};

using QueryPoolHandle = std::shared_ptr<QueryPool>;

}  // namespace tandem::rhi
