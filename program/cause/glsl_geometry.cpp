#include <spirv_cross/GLSL.std.450.h>

#include "program/cause/environment.hpp"
#include "program/cause/permitted.hpp"

/// GLSL.std.450 from Length to Refract: formulas of the table "Precision of GLSL.std.450 Instructions".
namespace tandem::program {
namespace {

using Ranges = std::span<const Range>;

Range length(const Rules& rules, Ranges x) { return inherited(square_root(rules, dot(rules, x, x))); }

Range distance(const Rules& rules, Ranges x, Ranges y) {
  std::vector<Range> difference;
  for (std::size_t i = 0; i < x.size(); ++i) difference.push_back(subtract(rules, x[i], y[i]));
  return length(rules, difference);
}

Range cross(const Rules& rules, Ranges x, Ranges y, std::size_t component) {
  const std::size_t i = (component + 1) % 3, j = (component + 2) % 3;
  return inherited(subtract(rules, multiply(rules, x[i], y[j]), multiply(rules, y[i], x[j])));
}

Range normalize(const Rules& rules, Ranges x, std::size_t component) {
  return inherited(multiply(rules, x[component], inverse_sqrt(rules, dot(rules, x, x))));
}

/// dot(reference, incident) < 0 ? normal : -normal
Range faceforward(const Rules& rules, Ranges normal, Ranges incident, Ranges reference, std::size_t component) {
  const Range side = dot(rules, reference, incident);
  const Range &same = normal[component], other = negate(same);
  if (side.open) return open(side.exact < 0 ? same.exact : other.exact, side.why);
  if (side.high < 0 && !side.may_be_zero) return same;
  if (side.low >= 0) return other;
  return side.exact < 0 ? either(same, other) : either(other, same);
}

/// x - 2 * dot(y, x) * y
Range reflect(const Rules& rules, Ranges x, Ranges y, std::size_t component) {
  const Range twice = multiply(rules, exactly(2), dot(rules, y, x));
  return inherited(subtract(rules, x[component], multiply(rules, twice, y[component])));
}

/// k < 0 ? 0 : eta * incident - (eta * dot(normal, incident) + sqrt(k)) * normal,
/// where k = 1 - eta * eta * (1 - dot(normal, incident) * dot(normal, incident))
Range refract(const Rules& rules, Ranges incident, Ranges normal, const Range& eta, std::size_t component) {
  const Range cosine = dot(rules, normal, incident);
  const Range sine = subtract(rules, exactly(1), multiply(rules, cosine, cosine));
  Range k = subtract(rules, exactly(1), multiply(rules, multiply(rules, eta, eta), sine));
  const bool none = k.exact < 0, may_be_none = k.low < 0;
  if (!k.open && k.high < 0) return exactly(0);
  if (none) k.exact = 0;
  if (may_be_none && !k.open) k.low = 0;
  const Range along = add(rules, multiply(rules, eta, cosine), square_root(rules, k));
  const Range refracted =
      subtract(rules, multiply(rules, eta, incident[component]), multiply(rules, along, normal[component]));
  if (none) return inherited(either(exactly(0), refracted));
  return inherited(may_be_none ? either(refracted, exactly(0)) : refracted);
}

bool is_geometric(std::uint32_t op) { return op >= GLSLstd450Length && op <= GLSLstd450Refract; }

Range evaluate(std::uint32_t op, const Rules& rules, Ranges all, std::size_t size, std::size_t component) {
  const Ranges x = all.first(size), rest = all.subspan(size);
  switch (op) {
    case GLSLstd450Length:
      return length(rules, x);
    case GLSLstd450Distance:
      return distance(rules, x, rest);
    case GLSLstd450Cross:
      return cross(rules, x, rest, component);
    case GLSLstd450Normalize:
      return normalize(rules, x, component);
    case GLSLstd450FaceForward:
      return faceforward(rules, x, rest.first(size), rest.subspan(size), component);
    case GLSLstd450Reflect:
      return reflect(rules, x, rest, component);
    default:
      return refract(rules, x, rest.first(size), rest[size], component);
  }
}

}  // namespace

std::optional<Permissions> permitted_glsl_geometry(const Call& call) {
  if (!is_geometric(call.glsl)) return std::nullopt;
  Scalars operands;
  for (std::size_t k = 0; k < call.operands.size(); ++k)
    operands.insert(operands.end(), call.operand(k).begin(), call.operand(k).end());
  bool is_zero = true;
  for (const Scalar& each : call.operand(0)) is_zero = is_zero && !each.undefined && real_of(each) == 0;
  const std::size_t size = call.operand(0).size();
  Permissions permissions;
  for (std::size_t i = 0; i < call.result.size(); ++i) {
    const Scalar like = call.result_scalar(i);
    if (call.glsl == GLSLstd450Normalize && is_zero) {
      permissions.push_back(undefined(like, "the vector is 0"));
      continue;
    }
    permissions.push_back(
        computed(rules_of(call.module, call.instruction, like.width), like.width, operands,
                 [&](const Rules& rules, Ranges all) { return evaluate(call.glsl, rules, all, size, i); }));
  }
  return permissions;
}

}  // namespace tandem::program
