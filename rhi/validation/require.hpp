#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "rhi/buffer.hpp"

/// What the rules are written with. Each throws Error(invalid_argument), in the name of `label`, where it does not
/// hold.
namespace tandem::rhi::validation {

void require(bool holds, std::string_view label, const std::string& why);

/// "buffer 'its label'".
std::string name_of(const BufferHandle& buffer);

/// `size` bytes from `offset` lie in the buffer. @param what names the use in the sentence, here and below
void require_inside(std::string_view label, const BufferHandle& buffer, std::uint64_t offset, std::uint64_t size,
                    const std::string& what);

/// The range is not empty and lies in its buffer.
void require_range(std::string_view label, const BufferRange& range, const std::string& what);

/// The buffer of the range has the usage, which `usage_name` names.
void require_usage(std::string_view label, const BufferRange& range, BufferUsage usage, const std::string& usage_name,
                   const std::string& what);

/// The range begins at a multiple of `alignment` bytes.
void require_alignment(std::string_view label, const BufferRange& range, std::uint64_t alignment,
                       const std::string& what);

/// value <= limit, which the device sets; the sentence is "`value` `things` are more than the device's `limit`".
void require_limit(std::uint64_t value, std::uint64_t limit, std::string_view label, const std::string& things);

}  // namespace tandem::rhi::validation
