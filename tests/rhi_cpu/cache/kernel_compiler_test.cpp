#include "rhi_cpu/cache/kernel_compiler.hpp"

#include <doctest/doctest.h>

#include <fstream>
#include <iterator>

#include "rhi/error.hpp"
#include "rhi_cpu/cache/kernel_headers.hpp"
#include "tests/support/environment_variable.hpp"
#include "tests/support/scratch_folder.hpp"

namespace tandem::cpu {
namespace {

using test::EnvironmentVariable;
using test::ScratchFolder;

std::string read(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

/// The Error that looking for a compiler for the shader "glow" throws.
rhi::Error search_error() {
  try {
    find_kernel_compiler("glow");
  } catch (const rhi::Error& error) {
    return error;
  }
  FAIL("a compiler was found");
  throw;
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("The program carries the kernel headers as they are in the source") {
  bool has_abi = false;
  for (const KernelHeader& header : kernel_headers()) {
    CHECK(read(std::filesystem::path(TANDEM_SOURCE_DIRECTORY) / header.path) == header.text);
    has_abi |= header.path == "rhi_cpu/kernel/abi.hpp";
  }
  CHECK(has_abi);
}

TEST_CASE("A compiler that TANDEM_CXX names but that does not run is one clear sentence") {
  const EnvironmentVariable chosen("TANDEM_CXX", "/nonexistent");
  const rhi::Error error = search_error();
  CHECK(error.code() == rhi::ErrorCode::shader_compilation);
  CHECK(error.label() == "glow");
  CHECK(contains(error.what(), "/nonexistent"));
  CHECK_FALSE(contains(error.what(), "\n"));
}

TEST_CASE("No compiler on PATH says what to install and what to set") {
  const ScratchFolder empty;
  const EnvironmentVariable chosen("TANDEM_CXX", std::nullopt);
  const EnvironmentVariable path("PATH", empty.path().string());
  const rhi::Error error = search_error();
  CHECK(error.code() == rhi::ErrorCode::shader_compilation);
  CHECK(contains(error.what(), "install g++"));
  CHECK(contains(error.what(), "TANDEM_CXX"));
}

TEST_CASE("TANDEM_CXX may be a name on PATH; the version is a part of the identity") {
  const EnvironmentVariable chosen("TANDEM_CXX", "c++");
  const KernelCompiler compiler = find_kernel_compiler("glow");
  CHECK(compiler.path.is_absolute());
  CHECK(contains(compiler.version, "."));
}

TEST_CASE("A compilation that fails gives its first error and keeps the whole log") {
  const ScratchFolder folder;
  std::ofstream(folder.path() / "kernel.cpp") << "int a = b;\nint c = d;\n";
  const std::string error = compile_kernel(find_kernel_compiler("glow"), folder.path());
  CHECK(contains(error, "kernel.cpp:1:"));
  CHECK(contains(error, "error:"));
  CHECK_FALSE(contains(error, "\n"));
  const std::string log = read(folder.path() / "compiler.log");
  CHECK(contains(log, "kernel.cpp:2:"));
  CHECK(contains(log, "-ffp-contract=off"));
}

}  // namespace tandem::cpu
