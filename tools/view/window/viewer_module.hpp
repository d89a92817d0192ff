#pragma once

#include "tools/view/window/viewer.hpp"

/// The window is in a shared library of its own, which `tandem view` opens: GLFW and OpenGL come with the libraries of
/// the display, and no other command needs them. Errors pass through: libstdc++ knows a type by its name.
namespace tandem::view {

struct ViewerModule {
  const char* version;  ///< of the Tandem that it was built with; another one's types may be laid out differently
  decltype(&view::run_viewer) run_viewer;
};

/// The function that the module exports under the name `viewer_entry`.
using ViewerEntry = const ViewerModule* (*)();
inline constexpr const char* viewer_entry = "tandem_viewer";

}  // namespace tandem::view
