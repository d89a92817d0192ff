#include "compare/probe/field.hpp"

#include <cstring>

namespace tandem::compare {

std::span<const ProbeField> probe_fields() {
  using enum ProbeField::Kind;
#define TANDEM_ELEMENT(name, member, index) \
  { name, number, offsetof(ProbeAnswer, member) + sizeof(float) * (index) }
#define TANDEM_VECTOR(name, member) \
  TANDEM_ELEMENT(name " x", member, 0), TANDEM_ELEMENT(name " y", member, 1), TANDEM_ELEMENT(name " z", member, 2)
#define TANDEM_ROW(name, row, member)                               \
  TANDEM_ELEMENT(name " (" #row ", 0)", member, 4 * (row)),         \
      TANDEM_ELEMENT(name " (" #row ", 1)", member, 4 * (row) + 1), \
      TANDEM_ELEMENT(name " (" #row ", 2)", member, 4 * (row) + 2), \
      TANDEM_ELEMENT(name " (" #row ", 3)", member, 4 * (row) + 3)
  static const ProbeField all[] = {
      {"type", identity, offsetof(ProbeAnswer, type)},
      {"instance", identity, offsetof(ProbeAnswer, instance)},
      {"geometry", identity, offsetof(ProbeAnswer, geometry)},
      {"primitive", identity, offsetof(ProbeAnswer, primitive)},
      {"custom index", flag, offsetof(ProbeAnswer, custom_index)},
      {"hit record", flag, offsetof(ProbeAnswer, record)},
      {"hit kind", flag, offsetof(ProbeAnswer, hit_kind)},
      {"t", number, offsetof(ProbeAnswer, t)},
      TANDEM_ELEMENT("barycentric u", barycentrics, 0),
      TANDEM_ELEMENT("barycentric v", barycentrics, 1),
      TANDEM_VECTOR("object origin", object_origin),
      TANDEM_VECTOR("object direction", object_direction),
      TANDEM_ROW("object to world", 0, object_to_world),
      TANDEM_ROW("object to world", 1, object_to_world),
      TANDEM_ROW("object to world", 2, object_to_world),
      TANDEM_ROW("world to object", 0, world_to_object),
      TANDEM_ROW("world to object", 1, world_to_object),
      TANDEM_ROW("world to object", 2, world_to_object),
  };
#undef TANDEM_ROW
#undef TANDEM_VECTOR
#undef TANDEM_ELEMENT
  return all;
}

std::uint32_t bits_of(const ProbeAnswer& answer, const ProbeField& field) {
  std::uint32_t bits = 0;
  std::memcpy(&bits, reinterpret_cast<const std::byte*>(&answer) + field.offset, sizeof(bits));
  return bits;
}

}  // namespace tandem::compare
