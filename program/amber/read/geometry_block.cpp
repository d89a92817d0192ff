#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "program/amber/read/parser.hpp"

// ACCELERATION_STRUCTURE.
namespace tandem::program::amber {
namespace {

using Flag = std::pair<std::string_view, std::uint32_t>;

constexpr std::array<Flag, 2> geometry_flags = {
    {{"OPAQUE", static_cast<std::uint32_t>(rhi::GeometryFlags::opaque)},
     {"NO_DUPLICATE_ANY_HIT", static_cast<std::uint32_t>(rhi::GeometryFlags::no_duplicate_any_hit)}}};

// What concerns opacity micromaps changes nothing for geometries that have none.
constexpr std::array<Flag, 6> instance_flags = {
    {{"TRIANGLE_FACING_CULL_DISABLE", static_cast<std::uint32_t>(rhi::InstanceFlags::triangle_facing_cull_disable)},
     {"TRIANGLE_FLIP_FACING", static_cast<std::uint32_t>(rhi::InstanceFlags::triangle_flip_facing)},
     {"FORCE_OPAQUE", static_cast<std::uint32_t>(rhi::InstanceFlags::force_opaque)},
     {"FORCE_NO_OPAQUE", static_cast<std::uint32_t>(rhi::InstanceFlags::force_no_opaque)},
     {"FORCE_OPACITY_MICROMAP_2_STATE", 0},
     {"DISABLE_OPACITY_MICROMAPS", 0}}};
constexpr std::uint32_t all_instance_flags = 15;

/// Words to the end of the line; or on lines of their own, to END.
template <std::size_t n>
std::uint32_t read_flags(Parser& parser, const std::array<Flag, n>& known) {
  std::uint32_t flags = 0;
  const bool on_one_line = !parser.at_line_end();
  for (;;) {
    Token token = on_one_line ? parser.next() : parser.next_in_block("FLAGS");
    if (token.ends_line() || (!on_one_line && token.is("END"))) return flags;
    if (token.kind == Token::Kind::number && !token.number.floating) {
      flags |= static_cast<std::uint32_t>(token.number.bits);
      continue;
    }
    const auto found = std::find_if(known.begin(), known.end(), [&](const Flag& each) { return token.is(each.first); });
    if (found == known.end()) parser.fail(token.position, fmt::format("'{}' is no flag", token.text.substr(0, 60)));
    flags |= found->second;
  }
}

void add_geometry(Parser& parser, BottomLevel& level, const Token& kind, const std::vector<float>& numbers,
                  rhi::GeometryFlags flags) {
  const bool triangles = kind.is("TRIANGLES");
  const std::size_t each = triangles ? 9 : 6;
  if (numbers.empty() || numbers.size() % each != 0)
    parser.fail(kind.position, fmt::format("{} coordinates are none of {}: each has {}", numbers.size(),
                                           triangles ? "triangles" : "boxes", each));
  if (triangles) {
    Triangles geometry;
    geometry.flags = flags;
    for (std::size_t i = 0; i < numbers.size(); i += 3)
      geometry.positions.push_back({numbers[i], numbers[i + 1], numbers[i + 2]});
    level.geometries.emplace_back(std::move(geometry));
  } else {
    Boxes geometry;
    geometry.flags = flags;
    for (std::size_t i = 0; i < numbers.size(); i += 6)
      geometry.boxes.push_back(
          {numbers[i], numbers[i + 1], numbers[i + 2], numbers[i + 3], numbers[i + 4], numbers[i + 5]});
    level.geometries.emplace_back(std::move(geometry));
  }
  if (level.geometries.front().index() != level.geometries.back().index())
    parser.fail(kind.position, fmt::format("the bottom level {} has triangles and boxes", level.name));
}

void read_geometry(Parser& parser, BottomLevel& level) {
  const Token kind = parser.name("TRIANGLES or AABBS");
  if (!kind.is("TRIANGLES") && !kind.is("AABBS"))
    parser.fail(kind.position, fmt::format("a geometry is TRIANGLES or AABBS, not '{}'", kind.text.substr(0, 60)));
  std::uint32_t flags = 0;
  std::vector<float> numbers;
  for (Token token = parser.next_in_block("GEOMETRY"); !token.is("END"); token = parser.next_in_block("GEOMETRY")) {
    if (token.is("FLAGS")) {
      flags = read_flags(parser, geometry_flags);
    } else if (token.kind == Token::Kind::number) {
      numbers.push_back(static_cast<float>(token.number.value));
    } else {
      parser.fail(token.position, fmt::format("a coordinate is expected, not '{}'", token.text.substr(0, 60)));
    }
  }
  add_geometry(parser, level, kind, numbers, static_cast<rhi::GeometryFlags>(flags & 3));
}

void read_bottom_level(Parser& parser) {
  BottomLevel level;
  const Position position = parser.lexer().position();
  level.name = parser.new_name("bottom level");
  for (Token token = parser.next_in_block("BOTTOM_LEVEL"); !token.is("END");
       token = parser.next_in_block("BOTTOM_LEVEL")) {
    if (!token.is("GEOMETRY"))
      parser.fail(token.position, fmt::format("GEOMETRY or END is expected, not '{}'", token.text.substr(0, 60)));
    read_geometry(parser, level);
  }
  if (level.geometries.empty()) parser.fail(position, fmt::format("the bottom level {} has no geometry", level.name));
  parser.draft().bottom_levels.push_back(std::move(level));
}

/// The options of an instance, to END.
void read_instance(Parser& parser, Instance& instance) {
  constexpr std::uint64_t largest_24_bits = (1 << 24) - 1;
  for (Token token = parser.next_in_block("BOTTOM_LEVEL_INSTANCE"); !token.is("END");
       token = parser.next_in_block("BOTTOM_LEVEL_INSTANCE")) {
    if (token.is("INDEX")) {
      instance.custom_index = static_cast<std::uint32_t>(parser.whole_number("INDEX", largest_24_bits));
    } else if (token.is("OFFSET")) {
      instance.sbt_offset = static_cast<std::uint32_t>(parser.whole_number("OFFSET", largest_24_bits));
    } else if (token.is("MASK")) {
      instance.mask = static_cast<std::uint32_t>(parser.whole_number("MASK", 255));
    } else if (token.is("FLAGS")) {
      instance.flags = static_cast<rhi::InstanceFlags>(read_flags(parser, instance_flags) & all_instance_flags);
    } else if (token.is("TRANSFORM")) {
      std::size_t count = 0;
      for (Token value = parser.next_in_block("TRANSFORM"); !value.is("END");
           value = parser.next_in_block("TRANSFORM")) {
        if (value.kind != Token::Kind::number || count == instance.object_to_world.size())
          parser.fail(value.position, "a transform is 12 numbers and END");
        instance.object_to_world[count++] = static_cast<float>(value.number.value);
      }
      if (count != instance.object_to_world.size())
        parser.fail(token.position, fmt::format("a transform is 12 numbers, not {}", count));
    } else {
      parser.fail(token.position, fmt::format("'{}' is no option of an instance", token.text.substr(0, 60)));
    }
  }
}

void read_top_level(Parser& parser) {
  TopLevel level;
  const Position position = parser.lexer().position();
  level.name = parser.new_name("top level");
  for (Token token = parser.next_in_block("TOP_LEVEL"); !token.is("END"); token = parser.next_in_block("TOP_LEVEL")) {
    Instance instance;
    const bool has_options = !token.is("BLAS_INSTANCE");
    if (!has_options) {
      parser.expect("USE");
    } else if (!token.is("BOTTOM_LEVEL_INSTANCE")) {
      parser.fail(token.position,
                  fmt::format("BOTTOM_LEVEL_INSTANCE or END is expected, not '{}'", token.text.substr(0, 60)));
    }
    const Token name = parser.name("a bottom level");
    instance.bottom_level = parser.bottom_level(name.text, name.position);
    if (has_options) read_instance(parser, instance);
    level.instances.push_back(instance);
  }
  if (level.instances.empty()) parser.fail(position, fmt::format("the top level {} has no instance", level.name));
  parser.draft().top_levels.push_back(std::move(level));
}

}  // namespace

void read_acceleration_structure(Parser& parser) {
  const Token level = parser.name("BOTTOM_LEVEL or TOP_LEVEL");
  if (level.is("BOTTOM_LEVEL")) {
    read_bottom_level(parser);
  } else if (level.is("TOP_LEVEL")) {
    read_top_level(parser);
  } else {
    parser.fail(level.position, fmt::format("an acceleration structure is BOTTOM_LEVEL or TOP_LEVEL, not '{}'",
                                            level.text.substr(0, 60)));
  }
  parser.end_line("END");
}

}  // namespace tandem::program::amber
