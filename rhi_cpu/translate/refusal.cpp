#include "rhi_cpu/translate/refusal.hpp"

#include "rhi/error.hpp"

namespace tandem::cpu {

void refuse(const std::string& label, const std::string& what) {
  throw rhi::Error(rhi::ErrorCode::unsupported, label, what + " is not supported by the CPU device");
}

}  // namespace tandem::cpu
