#pragma once

#include <span>
#include <string_view>

namespace tandem::kernels {

/// A file of glsl/.
struct Source {
  std::string_view stem;  ///< "n_body"
  std::string_view text;
};

/// Written by EmbedSources.cmake.
std::span<const Source> sources();

}  // namespace tandem::kernels
