#include "tools/suite/program_hash.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <system_error>
#include <vector>

#include "base/error.hpp"

// Inlined, so that the program needs no xxhash library.
#define XXH_INLINE_ALL
#include <xxhash.h>

namespace tandem::tools {

std::string program_hash() {
  constexpr const char* program = "/proc/self/exe";
  std::error_code error;
  std::vector<char> bytes;
  const std::uintmax_t size = std::filesystem::file_size(program, error);
  if (!error) bytes.resize(size);
  std::ifstream file(program, std::ios::binary);
  if (error || !file.read(bytes.data(), static_cast<std::streamsize>(bytes.size())))
    throw Error(fmt::format("cannot read '{}'", program));
  const XXH128_hash_t hash = XXH3_128bits(bytes.data(), bytes.size());
  return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

}  // namespace tandem::tools
