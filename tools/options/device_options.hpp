#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

/// --device of every command: names of devices as 'tandem devices' lists them, several as A,B or as A B, or with the
/// option repeated.
namespace tandem::tools {

/// One device. It must outlive the parsing, as those of the other functions. @param otherwise ends the sentence that
/// refuses more: "'tandem diff' compares two"
void add_device(CLI::App& command, std::string& device, const std::string& description, const std::string& otherwise);

/// As many devices as are given.
CLI::Option* add_devices(CLI::App& command, std::vector<std::string>& devices, const std::string& description);

/// Two devices, as --a and --b or as --device A,B.
void add_device_pair(CLI::App& command, std::string& a, std::string& b);

}  // namespace tandem::tools
