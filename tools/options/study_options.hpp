#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <string>

#include "rhi/device.hpp"

namespace tandem::tools {

/// What the studies that make a report of their own have in common.
struct StudyOptions {
  std::string device = "cpu";
  std::uint32_t threads = 0;       ///< of the CPU devices; 0: one per hardware thread
  std::filesystem::path json;      ///< empty: none
  std::filesystem::path markdown;  ///< likewise
  std::filesystem::path page;      ///< likewise; of studies that have one
};

/// What a study found, in each of the forms; `page` is "" where it has none.
struct StudyTexts {
  std::string markdown, json, page;
};

/// Declares --device, --threads, --json and --markdown. `options` must outlive the parsing.
void add_study_options(CLI::App& command, StudyOptions& options);

/// The device. Throws Error, also unless the files could be written now.
rhi::DeviceHandle open_study_device(const StudyOptions& options);

/// Prints the tables and writes the files that are asked for.
void finish_study(const StudyOptions& options, const StudyTexts& texts);

}  // namespace tandem::tools
