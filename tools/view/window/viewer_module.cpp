#include "tools/view/window/viewer_module.hpp"

extern "C" __attribute__((visibility("default"))) const tandem::view::ViewerModule* tandem_viewer() {
  static constexpr tandem::view::ViewerModule module = {.version = TANDEM_VERSION,
                                                        .run_viewer = &tandem::view::run_viewer};
  return &module;
}
