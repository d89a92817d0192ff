#include "base/unfinished_path.hpp"

#include <atomic>
#include <cstdlib>
#include <cstring>
#include <utility>

#include <unistd.h>

namespace tandem {
namespace {

/// What a handler finds: it belongs to the process as its signals do. More paths at once are not removed.
constexpr int slot_count = 64;
std::atomic<char*> slots[slot_count];

}  // namespace

UnfinishedPath::UnfinishedPath(const std::filesystem::path& path) {
  char* const name = strdup(std::filesystem::absolute(path).c_str());
  if (name == nullptr) return;
  for (int slot = 0; slot < slot_count; ++slot) {
    char* empty = nullptr;
    if (!slots[slot].compare_exchange_strong(empty, name)) continue;
    slot_ = slot;
    return;
  }
  std::free(name);
}

UnfinishedPath::~UnfinishedPath() {
  if (slot_ >= 0) std::free(slots[slot_].exchange(nullptr));
}

UnfinishedPath::UnfinishedPath(UnfinishedPath&& other) noexcept : slot_(std::exchange(other.slot_, -1)) {}

UnfinishedPath& UnfinishedPath::operator=(UnfinishedPath&& other) noexcept {
  std::swap(slot_, other.slot_);
  return *this;
}

void remove_unfinished_paths() noexcept {
  for (std::atomic<char*>& slot : slots) {
    const char* const name = slot.load();
    if (name != nullptr && unlink(name) != 0) rmdir(name);
  }
}

}  // namespace tandem
