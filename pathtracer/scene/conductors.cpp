#include "pathtracer/scene/conductors.hpp"

#include <algorithm>

namespace tandem::pathtracer {
namespace {

// Copper, gold, silver: P. B. Johnson and R. W. Christy, Optical constants of the noble metals, Phys. Rev. B 6, 1972.
// Chromium, iron, nickel, titanium: the same, Optical constants of transition metals, Phys. Rev. B 9, 1974.
// Aluminium: A. D. Rakic, Algorithm for the determination of intrinsic optical constants of metal films, Appl. Opt. 34,
// 1995. Linear between the wavelengths of their tables.
constexpr Conductor table[] = {
    {"aluminium", {1.558f, 1.015f, 0.633f}, {7.712f, 6.627f, 5.454f}},
    {"chromium", {3.107f, 3.181f, 2.323f}, {3.331f, 3.329f, 3.135f}},
    {"copper", {0.238f, 1.007f, 1.240f}, {3.626f, 2.582f, 2.393f}},
    {"gold", {0.156f, 0.424f, 1.383f}, {3.602f, 2.472f, 1.915f}},
    {"iron", {2.911f, 2.950f, 2.584f}, {3.089f, 2.932f, 2.767f}},
    {"nickel", {1.990f, 1.921f, 1.729f}, {4.209f, 3.616f, 2.944f}},
    {"silver", {0.052f, 0.060f, 0.040f}, {4.409f, 3.597f, 2.648f}},
    {"titanium", {2.741f, 2.542f, 2.267f}, {3.814f, 3.435f, 3.038f}},
};

}  // namespace

std::span<const Conductor> conductors() { return table; }

const Conductor* find_conductor(std::string_view name) {
  const Conductor* found = std::ranges::find(table, name, &Conductor::name);
  return found == std::end(table) ? nullptr : found;
}

}  // namespace tandem::pathtracer
