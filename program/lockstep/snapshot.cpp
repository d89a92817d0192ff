#include "program/lockstep/snapshot.hpp"

namespace tandem::program {

Snapshot snapshot_of(Execution& execution, const Job& job) {
  Snapshot snapshot;
  for (std::size_t i = 0; i < job.buffers.size(); ++i) snapshot.buffers.push_back(execution.buffer(i));
  for (std::size_t i = 0; i < job.images.size(); ++i) snapshot.images.push_back(execution.image(i));
  return snapshot;
}

void restore(Execution& execution, const Snapshot& snapshot) {
  for (std::size_t i = 0; i < snapshot.buffers.size(); ++i) execution.set_buffer(i, snapshot.buffers[i]);
  for (std::size_t i = 0; i < snapshot.images.size(); ++i) execution.set_image(i, snapshot.images[i]);
}

}  // namespace tandem::program
