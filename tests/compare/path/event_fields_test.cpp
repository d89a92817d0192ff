#include <doctest/doctest.h>

#include <set>
#include <string>

#include "compare/path/event_fields.hpp"

namespace tandem::compare {
namespace {

using pathtracer::EventKind;
using pathtracer::PathEvent;

TEST_CASE("the fields of an event lie beside each other, behind its kind and its segment") {
  for (std::uint32_t number = 1; number <= pathtracer::event_kind_count; ++number) {
    const auto kind = static_cast<EventKind>(number);
    CAPTURE(name(kind));
    CHECK_FALSE(fields_of(kind).empty());
    std::set<std::size_t> taken = {0, 1};
    std::set<std::string> names;
    for (const EventField& field : fields_of(kind)) {
      CAPTURE(field.name);
      CHECK(names.insert(field.name).second);
      for (std::size_t i = 0; i < word_count(field.type); ++i) CHECK(taken.insert(field.word + i).second);
      CHECK(field.word + word_count(field.type) <= PathEvent{}.words.size());
    }
  }
}

TEST_CASE("what does not enter the digest is what is only observed") {
  for (std::uint32_t number = 1; number <= pathtracer::event_kind_count; ++number)
    for (const EventField& field : fields_of(static_cast<EventKind>(number)))
      CHECK((field.tier == FieldTier::observed) == (field.word >= pathtracer::event_word::hit_t));
}

TEST_CASE("random bits stand for numbers from 0 to below 1") {
  CHECK(unit_interval(0) == 0.0f);
  CHECK(unit_interval(0x80000000u) == 0.5f);
  CHECK(unit_interval(0xffffffffu) == 1.0f - 0x1p-24f);
  CHECK(unit_interval(0xffu) == 0.0f);  // the lowest 8 bits do not count
}

}  // namespace
}  // namespace tandem::compare
