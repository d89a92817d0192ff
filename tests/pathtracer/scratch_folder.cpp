#include "tests/pathtracer/scratch_folder.hpp"

#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <system_error>

namespace tandem::test {

ScratchFolder::ScratchFolder()
    : path_(std::filesystem::temp_directory_path() / ("tandem-test-" + std::to_string(std::random_device{}()))) {
  std::filesystem::create_directories(path_);
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

std::filesystem::path ScratchFolder::write(std::string_view name, std::string_view text) const {
  const std::filesystem::path file = path_ / name;
  std::ofstream(file, std::ios::binary) << text;
  return file;
}

std::size_t ScratchFolder::size() const {
  return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(path_), {}));
}

}  // namespace tandem::test
