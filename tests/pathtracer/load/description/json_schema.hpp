#pragma once

#include <nlohmann/json.hpp>

namespace tandem::test {

/// As much of JSON Schema (draft 2020-12) as docs/schema/scene.schema.json uses; a keyword beyond that throws
/// std::logic_error.
class JsonSchema {
 public:
  explicit JsonSchema(nlohmann::json root);

  const nlohmann::json& root() const noexcept { return root_; }
  bool accepts(const nlohmann::json& value) const { return accepts(root_, value); }
  bool accepts(const nlohmann::json& schema, const nlohmann::json& value) const;
  /// What the schema says of the value itself: references followed, and of alternatives the one that accepts it.
  const nlohmann::json& resolve(const nlohmann::json& schema, const nlohmann::json& value) const;

 private:
  nlohmann::json root_;
};

}  // namespace tandem::test
