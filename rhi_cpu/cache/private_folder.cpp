#include "rhi_cpu/cache/private_folder.hpp"

#include <fcntl.h>
#include <sys/stat.h>

#include <cerrno>
#include <cstring>
#include <deque>
#include <system_error>

#include <fmt/format.h>

namespace tandem::cpu {
namespace {

namespace fs = std::filesystem;

constexpr mode_t others_write = S_IWGRP | S_IWOTH;
/// As many as Linux follows (path_resolution(7)).
constexpr int most_links = 40;

/// Whether the owner cannot work against this user.
bool is_trusted(uid_t owner) { return owner == ::geteuid() || owner == 0; }

/// Why what somebody owns and may write cannot be trusted, "" if it can.
std::string distrust(const struct stat& status) {
  if (!is_trusted(status.st_uid)) return fmt::format("belongs to another user (id {})", status.st_uid);
  if ((status.st_mode & S_IWOTH) != 0) return "may be written by everybody, so that nothing in it can be trusted";
  if ((status.st_mode & S_IWGRP) != 0) return "may be written by its group, so that nothing in it can be trusted";
  return {};
}

std::string distrust_of_parent(const struct stat& status) {
  const bool is_sticky = (status.st_mode & S_ISVTX) != 0;
  return is_trusted(status.st_uid) && is_sticky ? std::string() : distrust(status);
}

std::string cannot_be_opened(int error) { return fmt::format("cannot be opened: {}", std::strerror(error)); }

/// A path on its way from the root: what has been checked, and the names that are to follow.
struct Walk {
  fs::path done = "/";
  std::deque<fs::path> names;
  int links = 0;

  void follow(const fs::path& path) {
    names.insert(names.begin(), path.begin(), path.end());
    if (!path.is_absolute()) return;
    names.pop_front();
    done = "/";
  }
};

/// Takes the next name. @return why it cannot be passed, "" if it can
std::string step(Walk& walk) {
  const fs::path name = walk.names.front();
  walk.names.pop_front();
  if (name.empty() || name == ".") return {};
  if (name == "..") {
    walk.done = walk.done.parent_path();
    return {};
  }
  const fs::path next = walk.done / name;
  struct stat status {};
  if (::lstat(next.c_str(), &status) != 0) {
    // Another process may have made it meanwhile; what it made is looked at all the same.
    if (errno == ENOENT && ::mkdir(next.c_str(), S_IRWXU) != 0 && errno != EEXIST)
      return fmt::format("cannot be created: {}", std::strerror(errno));
    if (::lstat(next.c_str(), &status) != 0) return cannot_be_opened(errno);
  }
  if (S_ISLNK(status.st_mode)) {
    if (!is_trusted(status.st_uid)) return fmt::format("is reached by the link {} of another user", next.string());
    if (++walk.links > most_links) return cannot_be_opened(ELOOP);
    std::error_code error;
    const fs::path target = fs::read_symlink(next, error);
    if (error) return cannot_be_opened(error.value());
    walk.follow(target);
    return {};
  }
  if (!S_ISDIR(status.st_mode))
    return walk.names.empty() ? "is not a folder" : fmt::format("is below {}, which is not a folder", next.string());
  const bool is_last = walk.names.empty();
  const std::string problem = is_last ? distrust(status) : distrust_of_parent(status);
  walk.done = next;
  if (problem.empty()) return {};
  return is_last ? problem : fmt::format("is below {}, which {}", next.string(), problem);
}

}  // namespace

PrivateFolder::PrivateFolder(FileDescriptor descriptor, fs::path path)
    : descriptor_(std::move(descriptor)), path_(std::move(path)) {}

std::variant<PrivateFolder, std::string> PrivateFolder::open(const fs::path& folder) {
  Walk walk;
  walk.follow(folder);
  struct stat root {};
  if (::stat("/", &root) != 0) return cannot_be_opened(errno);
  if (const std::string problem = distrust_of_parent(root); !problem.empty()) return "is below /, which " + problem;
  while (!walk.names.empty())
    if (std::string problem = step(walk); !problem.empty()) return problem;
  FileDescriptor descriptor(::open(walk.done.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC));
  if (!descriptor) return cannot_be_opened(errno);
  // What was opened counts, not what the name stood for a moment before.
  struct stat status {};
  if (::fstat(descriptor.get(), &status) != 0) return cannot_be_opened(errno);
  if (std::string problem = distrust(status); !problem.empty()) return problem;
  return PrivateFolder(std::move(descriptor), walk.done);
}

PrivateFile PrivateFolder::open_file(std::string_view name) const {
  PrivateFile file;
  FileDescriptor descriptor(::openat(descriptor_.get(), std::string(name).c_str(),
                                     O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY | O_CLOEXEC));
  struct stat status {};
  if (!descriptor) {
    if (errno == ELOOP)
      file.problem = "is a symbolic link";
    else if (errno != ENOENT)
      file.problem = cannot_be_opened(errno);
  } else if (::fstat(descriptor.get(), &status) != 0) {
    file.problem = cannot_be_opened(errno);
  } else if (!S_ISREG(status.st_mode)) {
    file.problem = "is not a regular file";
  } else if (!is_trusted(status.st_uid)) {
    file.problem = "belongs to another user";
  } else if ((status.st_mode & others_write) != 0) {
    file.problem = "may be written by other users";
  } else {
    file.descriptor = std::move(descriptor);
  }
  return file;
}

}  // namespace tandem::cpu
