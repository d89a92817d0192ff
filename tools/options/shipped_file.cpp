#include "tools/options/shipped_file.hpp"

#include <system_error>

namespace tandem::tools {

std::filesystem::path shipped_scene(const std::string& name) {
  namespace fs = std::filesystem;
  const fs::path usual = fs::path("scenes") / name;
  std::error_code ignored;
  if (fs::exists(usual, ignored)) return usual;
  const fs::path program_folder = fs::read_symlink("/proc/self/exe", ignored).parent_path();
  // PREFIX/bin and PREFIX/share; the folder of a bundle; build/PRESET of the source.
  for (const char* const place : {"../share/tandem", "..", "../.."}) {
    const fs::path file = (program_folder / place / usual).lexically_normal();
    if (!program_folder.empty() && fs::exists(file, ignored)) return file;
  }
  return usual;
}

}  // namespace tandem::tools
