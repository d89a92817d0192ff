#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tools/kernels/problem.hpp"

/// Compute kernels that `tandem bench --kernels` measures: GLSL in glsl/, each with a problem whose answer is known.
namespace tandem::kernels {

struct Kernel {
  const char* name;         ///< "n-body"; its source is glsl/n_body.comp
  const char* description;  ///< of the usual size, for the help and the reports
  Problem (*problem)(Size size);

  /// The GLSL, which is embedded.
  std::string_view source() const;
};

std::span<const Kernel> kernels();

/// The kernels of a list "fft,n-body", in its order; all for an empty one. Throws tandem::Error for a name that none
/// has, that is empty or that is named twice.
std::vector<Kernel> named_kernels(const std::string& list);

}  // namespace tandem::kernels
