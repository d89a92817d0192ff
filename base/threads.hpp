#pragma once

namespace tandem {

/// Starts as many threads at once as drivers and libraries are going to, and ends them again: some of those end the
/// program where they cannot have one. Throws Error with the system's reason.
void require_threads();

}  // namespace tandem
