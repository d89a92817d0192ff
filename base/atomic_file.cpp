#include "base/atomic_file.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <random>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "base/error.hpp"

namespace tandem {

std::filesystem::path link_target(std::filesystem::path path) {
  constexpr int most_links = 40;  // as Linux follows at most
  const std::filesystem::path named = path;
  std::error_code status_error;
  for (int links = 0; std::filesystem::is_symlink(path, status_error); ++links) {
    if (links == most_links)
      throw Error(fmt::format("cannot write '{}': its symbolic links lead nowhere", named.string()));
    path = path.parent_path() / std::filesystem::read_symlink(path);  // an absolute target stands for itself
  }
  return path;
}

AtomicFile::AtomicFile(std::filesystem::path path) : path_(std::move(path)), target_(link_target(path_)) {
  std::error_code status_error;
  if (target_.filename().empty() || std::filesystem::is_directory(target_, status_error))
    throw Error(fmt::format("cannot write '{}': it is a folder", path_.string()));
  // A device such as /dev/null would be replaced by a file.
  if (std::filesystem::exists(target_, status_error) && !std::filesystem::is_regular_file(target_, status_error))
    throw Error(fmt::format("cannot write '{}': it is not a regular file", path_.string()));
  std::filesystem::path folder = target_.parent_path();
  if (folder.empty()) folder = ".";
  if (!std::filesystem::is_directory(folder, status_error))
    throw Error(fmt::format("cannot write '{}': there is no folder '{}'", path_.string(), folder.string()));

  // Random rather than the process id: containers that share a folder share process ids too.
  const std::uint32_t unique = std::random_device{}();
  const std::filesystem::path temporary =
      folder / fmt::format(".{}.{:08x}{}", target_.stem().string(), unique, target_.extension().string());
  unfinished_ = UnfinishedPath(temporary);
  if (!std::ofstream(temporary, std::ios::binary))
    throw Error(fmt::format("cannot write '{}': {}", path_.string(), std::strerror(errno)));
  temporary_path_ = temporary;
}

AtomicFile::~AtomicFile() {
  std::error_code ignored;  // the file may be gone together with its folder, and a destructor has nobody to tell
  if (!committed_) std::filesystem::remove(temporary_path_, ignored);
}

void AtomicFile::write(std::span<const std::byte> bytes) {
  errno = 0;
  std::ofstream stream(temporary_path_, std::ios::binary);
  stream.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  stream.close();  // what fails only here, when the last of it reaches the disk, must be seen too
  if (!stream) throw Error(fmt::format("cannot write '{}': {}", path_.string(), std::strerror(errno)));
}

void AtomicFile::commit() {
  std::error_code error;
  std::filesystem::rename(temporary_path_, target_, error);
  if (error) throw Error(fmt::format("cannot write '{}': {}", path_.string(), error.message()));
  committed_ = true;
  unfinished_ = {};
}

}  // namespace tandem
