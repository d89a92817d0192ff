#include "pathtracer/load/access/file_access.hpp"

#include <algorithm>
#include <system_error>

#include <fmt/format.h>

namespace tandem::pathtracer {
namespace {

/// Absolute, without links. Empty where that cannot be told, as in a circle of links.
std::filesystem::path resolved(const std::filesystem::path& path) {
  std::error_code error;
  const std::filesystem::path absolute = std::filesystem::absolute(path, error);
  if (error) return {};
  std::filesystem::path result = std::filesystem::weakly_canonical(absolute, error);
  return error ? std::filesystem::path() : result;
}

bool is_below(const std::filesystem::path& path, const std::filesystem::path& folder) {
  return std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first == folder.end();
}

}  // namespace

LoadOptions options_within(const std::filesystem::path& file, LoadOptions options) {
  if (options.folder.empty()) options.folder = file.has_parent_path() ? file.parent_path() : ".";
  return options;
}

bool may_read(const std::filesystem::path& file, const LoadOptions& options) {
  if (options.allow_outside_files) return true;
  const std::filesystem::path target = resolved(file);
  std::filesystem::path folder = resolved(options.folder);
  if (target.empty() || folder.empty()) return false;
  if (!folder.has_filename()) folder = folder.parent_path();
  return is_below(target, folder) || is_below(target, folder.parent_path() / "textures");
}

std::string outside_sentence(const std::filesystem::path& file) {
  return fmt::format("the file '{}' is outside of the scene's folder; --allow-outside-files allows it", file.string());
}

}  // namespace tandem::pathtracer
