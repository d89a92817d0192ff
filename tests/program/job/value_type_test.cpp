#include "program/job/value_type.hpp"

#include <doctest/doctest.h>

#include <string>
#include <vector>

using namespace tandem::program;

namespace {

/// struct { uint count; vec3 position[2]; mat3x2 m (rows 16 bytes apart); Item { float16 a; ivec2 b; } items[]; }
ValueType block() {
  const ValueType matrix{.kind = ValueType::Kind::matrix,
                         .scalar = ScalarType::float32,
                         .rows = 2,
                         .columns = 3,
                         .row_major = true,
                         .stride = 16,
                         .size = 32};
  const ValueType item{.kind = ValueType::Kind::structure,
                       .size = 16,
                       .members = {{"a", 0, make_type(ScalarType::float16)}, {"b", 8, make_type(ScalarType::int32, 2)}},
                       .name = "Item"};
  return {.kind = ValueType::Kind::structure,
          .size = 80,
          .members = {{"count", 0, make_type(ScalarType::uint32)},
                      {"position", 16, make_array(make_type(ScalarType::float32, 3), 2, 16)},
                      {"m", 48, matrix},
                      {"items", 80, make_array(item, 0)}},
          .name = "Block"};
}

struct Scalar {
  std::string path;
  std::uint64_t offset;
  ScalarType scalar;
  bool operator==(const Scalar&) const = default;
};

std::vector<Scalar> scalars_of(const ValueType& type, std::uint64_t bytes) {
  std::vector<Scalar> scalars;
  for (std::uint64_t i = 0; i < scalar_count(type, bytes); ++i) {
    const Place place = place_of(type, bytes, i);
    scalars.push_back({path_of(type, bytes, i), place.offset, place.scalar});
  }
  return scalars;
}

TEST_CASE("every scalar of a block has its path, place and type") {
  const ScalarType f32 = ScalarType::float32, i32 = ScalarType::int32, f16 = ScalarType::float16;
  // Two items and a half: the half does not count.
  CHECK(scalars_of(block(), 80 + 40) == std::vector<Scalar>{{"count", 0, ScalarType::uint32},
                                                            {"position[0].x", 16, f32},
                                                            {"position[0].y", 20, f32},
                                                            {"position[0].z", 24, f32},
                                                            {"position[1].x", 32, f32},
                                                            {"position[1].y", 36, f32},
                                                            {"position[1].z", 40, f32},
                                                            {"m[0][0]", 48, f32},
                                                            {"m[0][1]", 64, f32},
                                                            {"m[1][0]", 52, f32},
                                                            {"m[1][1]", 68, f32},
                                                            {"m[2][0]", 56, f32},
                                                            {"m[2][1]", 72, f32},
                                                            {"items[0].a", 80, f16},
                                                            {"items[0].b.x", 88, i32},
                                                            {"items[0].b.y", 92, i32},
                                                            {"items[1].a", 96, f16},
                                                            {"items[1].b.x", 104, i32},
                                                            {"items[1].b.y", 108, i32}});
}

TEST_CASE("a walk over all places gives them in the order of their numbers") {
  std::vector<std::uint64_t> walked, numbered;
  for_each_place(
      block(), 130, [&](const Place& place) { walked.push_back(place.offset); }, 1000);
  for (std::uint64_t i = 0; i < scalar_count(block(), 130); ++i)
    numbered.push_back(1000 + place_of(block(), 130, i).offset);
  CHECK(walked == numbered);
  CHECK(walked.size() == 22);
}

TEST_CASE("values that are no structures have paths that follow a name") {
  CHECK(path_of(make_type(ScalarType::uint8), 1, 0).empty());
  CHECK(path_of(make_type(ScalarType::uint8, 4), 4, 3) == ".w");
  CHECK(path_of(make_array(make_type(ScalarType::float64), 0), 64, 7) == "[7]");
  CHECK(path_of(make_array(make_array(make_type(ScalarType::int16, 2), 3), 2), 24, 7) == "[1][0].y");
}

TEST_CASE("an array without a length has as many elements as lie in the bytes") {
  const ValueType words = make_array(make_type(ScalarType::uint32), 0);
  CHECK(words.size == 0);
  CHECK(scalar_count(words, 0) == 0);
  CHECK(scalar_count(words, 11) == 2);
  CHECK(scalar_count(block(), 80) == 13);
}

TEST_CASE("types are described in GLSL's words") {
  CHECK(describe(make_type(ScalarType::uint32)) == "uint");
  CHECK(describe(make_type(ScalarType::float32, 3)) == "vec3");
  CHECK(describe(make_type(ScalarType::float64, 2)) == "dvec2");
  CHECK(describe(make_type(ScalarType::uint8, 4)) == "u8vec4");
  CHECK(describe(make_type(ScalarType::float16)) == "float16_t");
  CHECK(describe(make_array(make_array(make_type(ScalarType::int64), 3), 2)) == "int64_t[2][3]");
  CHECK(describe(make_array(block(), 0)) == "Block[]");
  CHECK(describe(block().members[2].type) == "mat3x2");
}

TEST_CASE("scalars have sizes, names and signs") {
  CHECK(size_of(ScalarType::uint8) == 1);
  CHECK(size_of(ScalarType::float16) == 2);
  CHECK(size_of(ScalarType::int64) == 8);
  CHECK(name_of(ScalarType::uint16) == "uint16");
  CHECK(is_floating(ScalarType::float16));
  CHECK_FALSE(is_floating(ScalarType::int32));
  CHECK(is_signed(ScalarType::float64));
  CHECK(is_signed(ScalarType::int8));
  CHECK_FALSE(is_signed(ScalarType::uint64));
}

}  // namespace
