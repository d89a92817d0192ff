#include "rhi/validation/require.hpp"

#include "rhi/error.hpp"

namespace tandem::rhi::validation {

using std::to_string;

void require(bool holds, std::string_view label, const std::string& why) {
  if (!holds) throw Error(ErrorCode::invalid_argument, label, why);
}

std::string name_of(const BufferHandle& buffer) { return "buffer '" + buffer->desc().label + "'"; }

// Written so that nothing overflows.
void require_inside(std::string_view label, const BufferHandle& buffer, std::uint64_t offset, std::uint64_t size,
                    const std::string& what) {
  require(buffer != nullptr, label, what + " names no buffer");
  require(offset <= buffer->size() && size <= buffer->size() - offset, label,
          what + " needs bytes [" + to_string(offset) + ", " + to_string(offset) + " + " + to_string(size) + ") of " +
              name_of(buffer) + ", which has " + to_string(buffer->size()));
}

void require_range(std::string_view label, const BufferRange& range, const std::string& what) {
  require(!range.empty(), label, what + " names no buffer");
  require(range.offset < range.buffer->size(), label,
          what + " begins at byte " + to_string(range.offset) + " of " + name_of(range.buffer) + ", which has " +
              to_string(range.buffer->size()));
  require_inside(label, range.buffer, range.offset, range.resolved_size(), what);
}

void require_usage(std::string_view label, const BufferRange& range, BufferUsage usage, const std::string& usage_name,
                   const std::string& what) {
  require(has(range.buffer->desc().usage, usage), label,
          what + ": " + name_of(range.buffer) + " lacks the usage " + usage_name);
}

void require_alignment(std::string_view label, const BufferRange& range, std::uint64_t alignment,
                       const std::string& what) {
  require(range.offset % alignment == 0, label,
          what + " begins at byte " + to_string(range.offset) + ", which is no multiple of " + to_string(alignment));
}

void require_limit(std::uint64_t value, std::uint64_t limit, std::string_view label, const std::string& things) {
  require(value <= limit, label, to_string(value) + " " + things + " are more than the device's " + to_string(limit));
}

}  // namespace tandem::rhi::validation
