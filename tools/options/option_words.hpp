#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

/// A command line before its options are read.
namespace tandem::tools {

/// The option's name of today: "--spp" for "--samples", as settings were called in scene files before; others as they
/// are.
std::string_view current_name(std::string_view option);

/// The words of a command line, without the program, in their order, with old names of options replaced, and with
/// device names that follow `--device A` joined to its value: `--device cpu vulkan scene.obj` becomes
/// `--device cpu,vulkan scene.obj`. Only words of the form of a device's name are, so that a file behind them is not
/// taken for one. Throws Error for a list of devices with an empty name in it.
std::vector<std::string> option_words(std::span<const char* const> arguments);

}  // namespace tandem::tools
