#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "program/explain/explanation.hpp"
#include "rhi/device.hpp"
#include "tools/program/results.hpp"

/// A comparison of two devices on a program, for people who open it in a browser.
namespace tandem::tools::program_run {

/// Pictures of a resource, as PNG files; empty where there is none.
struct ResourcePictures {
  std::vector<std::byte> a, b;        ///< of images whose format becomes a picture
  std::vector<std::byte> difference;  ///< difference_map(); of what differs
  std::string scale;                  ///< what a pixel of `difference` stands for
};

/// Throws Error where there is no image library.
ResourcePictures pictures_of(const BuiltJob& built, std::size_t resource, const Contents& a, const Contents& b);

/// What a page shows. What it refers to must live while the page is made.
struct ProgramPage {
  std::string input;    ///< the shader or script
  std::string verdict;  ///< in words
  bool agrees = false, is_wrong = false;
  const rhi::DeviceInfo& a;
  const rhi::DeviceInfo& b;
  const BuiltJob& built;
  const std::vector<ResourceComparison>& comparisons;
  const std::vector<ResourcePictures>& pictures;  ///< of each comparison
  program::Tolerance tolerance;
  const program::Explanation* explanation = nullptr;  ///< null: nothing had to be explained
};

/// The whole page: it refers to no other file and to no address. UTF-8.
std::string program_page(const ProgramPage& contents);

}  // namespace tandem::tools::program_run
