#include "tools/output/output_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <set>
#include <system_error>

#include "base/atomic_file.hpp"
#include "base/error.hpp"
#include "tools/output/interruption.hpp"
#include "tools/output/print.hpp"

namespace tandem::tools {
namespace {

/// A new folder that nobody else can have prepared. Throws std::system_error.
std::filesystem::path make_temporary_folder() {
  std::string path = (std::filesystem::temp_directory_path() / "tandem-rescue-XXXXXX").string();
  if (mkdtemp(path.data()) == nullptr) throw std::system_error(errno, std::generic_category(), path);
  return path;
}

}  // namespace

void check_output_path(const std::filesystem::path& path) {
  // Creates the temporary file that a write would begin with, and removes it again.
  const AtomicFile probe(path);
}

OutputFolder::OutputFolder(std::filesystem::path path) : path_(std::move(path)) {
  std::error_code error;
  for (std::filesystem::path missing = path_; !missing.empty() && !std::filesystem::exists(missing, error);
       missing = missing.parent_path()) {
    made_.push_back(missing);
    unfinished_.emplace_back(missing);
  }
  error.clear();
  std::filesystem::create_directories(path_, error);
  if (!std::filesystem::is_directory(path_)) {
    throw Error(fmt::format("cannot create the folder '{}': {}", path_.string(),
                            error ? error.message() : "a file of that name exists"));
  }
}

OutputFolder::~OutputFolder() {
  // Fails, as it should, when there is anything inside.
  std::error_code not_empty;
  for (const std::filesystem::path& folder : made_) std::filesystem::remove(folder, not_empty);
}

void write_text(const std::filesystem::path& path, const std::string& text) {
  AtomicFile file(path);
  file.write(std::as_bytes(std::span(text)));
  file.commit();
}

void check_output_files(std::span<const OutputFile> files) {
  std::set<std::filesystem::path> paths;
  for (const OutputFile& file : files) {
    check_output_path(file.path);
    if (!paths.insert(std::filesystem::weakly_canonical(link_target(file.path))).second) {
      throw Error(fmt::format("two results would be written into '{}'", file.path.string()));
    }
  }
}

void write_or_rescue(std::span<const OutputFile> files) {
  const Saving saving;
  std::filesystem::path rescue;
  std::error_code not_empty;
  std::string first_reason;
  std::string first_loss;
  for (const OutputFile& file : files) {
    try {
      file.write(file.path);
      continue;
    } catch (const std::exception& error) {
      if (first_reason.empty()) first_reason = error.what();
    }
    try {
      if (rescue.empty()) rescue = make_temporary_folder();
      file.write(rescue / file.path.filename());
    } catch (const std::exception& error) {
      if (first_loss.empty()) first_loss = error.what();
    }
  }
  if (!rescue.empty()) std::filesystem::remove(rescue, not_empty);
  if (!first_loss.empty()) throw Error(fmt::format("{}; saving it elsewhere failed too: {}", first_reason, first_loss));
  if (!first_reason.empty()) {
    throw Error(fmt::format("{}; what could not be written there was saved in '{}'", first_reason, rescue.string()));
  }
}

void print_written(std::span<const OutputFile> files) {
  constexpr std::size_t most_names = 12;
  std::vector<std::filesystem::path> folders;
  for (const OutputFile& file : files)
    if (std::ranges::count(folders, file.path.parent_path()) == 0) folders.push_back(file.path.parent_path());
  for (const std::filesystem::path& folder : folders) {
    std::vector<std::string> names;
    for (const OutputFile& file : files)
      if (file.path.parent_path() == folder) names.push_back(file.path.filename().string());
    if (names.size() == 1) {
      tools::print("{:<18}{}\n", "wrote", (folder / names.front()).string());
      continue;
    }
    const std::size_t more = names.size() - std::min(names.size(), most_names);
    names.resize(names.size() - more);
    tools::print("{:<18}{}: {}{}\n", "wrote", folder.empty() ? "." : folder.string(), fmt::join(names, ", "),
                 more == 0 ? "" : fmt::format(" and {} more", more));
  }
}

}  // namespace tandem::tools
