#pragma once

#include <string>

namespace tandem::tools {

/// 32 hexadecimal digits that stand for this very build of the program (XXH3, 128 bits, of its file): any change of a
/// shader or of a backend gives others, which a version does not. Throws Error when the file cannot be
/// read.
std::string program_hash();

}  // namespace tandem::tools
